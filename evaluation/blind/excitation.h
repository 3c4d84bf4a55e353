/// The commands of recordings with a withheld cause.
#pragma once

#include <string>
#include <vector>

#include "musclesim/base/random.h"
#include "musclesim/log/recording.h"

namespace musclesim::blind {

/// How a robot's muscles are arranged: one alone, two against each other, or many.
enum class Layout { one_muscle, pair, many };
Layout layoutOf(int muscle_count);

/// The excitation of one recording. `speed` 1: moves that take seconds; amplitude: of the difference between antagonists, or of a single
/// muscle, as a fraction of full scale.
struct Excitation {
  std::string kind;  ///< "triangle", "steps", "reversals", "multisine", "holds"
  double amplitude = 0, speed = 1;
};

/// Values between -1 and 1, 100 per second, 0 in the first 0.3 s. Throws BadParameter for an unknown kind.
std::vector<double> shapeOf(const std::string& kind, double speed, double duration_s, RandomStream& random);

/// Three excitations for fitting (triangle; steps of several sizes; reversals, multisine or holds), then one of another kind, speed and
/// amplitude for measuring the result.
std::vector<Excitation> drawExcitations(Layout layout, RandomStream& random);

/// The commands as a recording without measurements. One muscle: around 0.32..0.48. A pair: both around 0.3..0.48, against each other,
/// sometimes with co-contraction; the caller keeps the joint off its stops. Many: all around one value in 0.06..0.18, each with a small
/// motion of its own, so that the robot moves gently. `robot`: a name or a robot file.
Recording planned(const std::string& robot, int muscle_count, const Excitation& excitation, double duration_s, RandomStream& random);

}  // namespace musclesim::blind
