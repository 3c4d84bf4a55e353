#include "unit_check.h"

#include <fmt/format.h>

#include "data_checks.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double thousand_low = 300, thousand_high = 3000;

}  // namespace

void requireUnits(const Plant& plant, int recording, const Prediction& prediction) {
  for (std::size_t i = 0; i < plant.signals().size(); ++i) {
    const double measured = medianSize(plant.measured(recording, static_cast<int>(i))), predicted = medianSize(prediction.values[i]);
    if (measured <= 0 || predicted <= plant.signals()[i].sigma.value) continue;
    const double ratio = measured / predicted;
    for (const double factor : {ratio, 1 / ratio})
      if (factor > thousand_low && factor < thousand_high)
        throw BadFile(plant.recordings()[static_cast<std::size_t>(recording)].file,
                      fmt::format("{} is about {:.3g}, but must be in the unit of its name: the model's values are about {:.3g}, which is "
                                  "about a thousand times {}",
                                  plant.signals()[i].name, measured, predicted, ratio > 1 ? "less" : "more"));
  }
}

}  // namespace musclesim
