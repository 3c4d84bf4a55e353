#include "out_of_catalogue.h"

#include <cmath>
#include <mutex>

#include "laws_by_stage.h"
#include "musclesim/base/random.h"
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

namespace out_of_catalogue {

double wander(std::uint64_t seed, double time_s, double interval_s) {
  const double place = std::floor(time_s / interval_s), share = time_s / interval_s - place;
  auto drawn = [&](double at) { return RandomStream(seed, "wander." + std::to_string(static_cast<long>(at))).uniform(-1, 1); };
  return (1 - share) * drawn(place) + share * drawn(place + 1);
}

}  // namespace out_of_catalogue

}  // namespace musclesim
