#include "wander.h"

#include <cmath>
#include <string>

#include "musclesim/base/random.h"

namespace musclesim::out_of_catalogue {

double wander(std::uint64_t seed, double time_s, double interval_s) {
  const double place = std::floor(time_s / interval_s), share = time_s / interval_s - place;
  auto drawn = [&](double at) { return RandomStream(seed, "wander." + std::to_string(static_cast<long>(at))).uniform(-1, 1); };
  return (1 - share) * drawn(place) + share * drawn(place + 1);
}

}  // namespace musclesim::out_of_catalogue
