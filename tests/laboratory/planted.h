/// Static points made from a known law, with noise.
#pragma once

#include <cmath>

#include "laboratory/law_fit.h"
#include "musclesim/base/random.h"

namespace musclesim {

/// Meaning of a noise of 1 %: of the largest force (an instrument's error), or of each force (a varying gain).
enum class NoiseOf { largest, each };

/// 9 pressures from 0 to 1 times 11 lengths from 120 to 300 mm.
inline StaticPoints plantedPoints(const ForceLaw& law, double noise_ratio, NoiseOf noise_of, std::uint64_t seed) {
  constexpr int pressure_count = 9, length_count = 11;
  constexpr double shortest_mm = 120, longest_mm = 300;
  RandomStream random(seed, "planted points");
  const double largest_N = law.tensionN(1, longest_mm);
  StaticPoints points;
  points.file = "planted.csv";
  for (int i = 0; i < pressure_count; ++i)
    for (int j = 0; j < length_count; ++j) {
      StaticPoint point;
      point.line = 2 + i * length_count + j;
      point.pressure_ratio = static_cast<double>(i) / (pressure_count - 1);
      point.length_mm = shortest_mm + (longest_mm - shortest_mm) * j / (length_count - 1);
      const double force_N = law.tensionN(point.pressure_ratio, point.length_mm);
      point.force_N = force_N + noise_ratio * (noise_of == NoiseOf::largest ? largest_N : force_N) * random.normal();
      points.points.push_back(point);
    }
  return points;
}

}  // namespace musclesim
