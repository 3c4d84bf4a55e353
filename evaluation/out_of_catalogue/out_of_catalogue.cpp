#include "out_of_catalogue.h"

#include <mutex>

#include "laws_by_stage.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim {

const std::vector<OutOfCatalogueLaw>& outOfCatalogueLaws() {
  static const std::vector<OutOfCatalogueLaw> all = [] {
    std::vector<OutOfCatalogueLaw> list;
    for (const auto& laws : {out_of_catalogue::commandLaws(), out_of_catalogue::pressureLaws(), out_of_catalogue::forceLaws(),
                             out_of_catalogue::bodyLaws(), out_of_catalogue::sensorLaws(), out_of_catalogue::openEffects()})
      list.insert(list.end(), laws.begin(), laws.end());
    return list;
  }();
  return all;
}

void registerOutOfCatalogueLaws() {
  static std::once_flag once;
  std::call_once(once, [] {
    for (const OutOfCatalogueLaw& law : outOfCatalogueLaws()) registerEffect(law.info);
  });
}

}  // namespace musclesim
