#include "foreign.h"

#include <cmath>

#include "musclesim/random.h"

namespace musclesim {

const std::vector<ForeignEffect>& foreignEffects() {
  static const std::vector<ForeignEffect> all = [] {
    std::vector<ForeignEffect> list;
    for (const auto& laws : {foreign::commandLaws(), foreign::pressureLaws(), foreign::forceLaws(), foreign::bodyLaws(),
                             foreign::sensorLaws(), foreign::openEffects()})
      list.insert(list.end(), laws.begin(), laws.end());
    return list;
  }();
  return all;
}

namespace foreign {

double wander(std::uint64_t seed, double time_s, double interval_s) {
  const double place = std::floor(time_s / interval_s), share = time_s / interval_s - place;
  auto drawn = [&](double at) { return RandomStream(seed, "wander." + std::to_string(static_cast<long>(at))).uniform(-1, 1); };
  return (1 - share) * drawn(place) + share * drawn(place + 1);
}

}  // namespace foreign

}  // namespace musclesim
