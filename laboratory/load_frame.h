/// The paper's experiment in the simulator: a muscle in the load frame, its length under loads, its force at lengths.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// A muscle of the load frame. The paper measures a short, a medium and a long one and does not give their lengths; these are a choice.
struct FrameSpecimen {
  std::string name;
  double minimum_mm, maximum_mm;
};

/// short 60/200, medium 75/300, long 60/350 mm.
const std::vector<FrameSpecimen>& frameSpecimens();
/// 0, 32, ... 224, 255 of 255: the steps of an 8-bit pressure command, as fractions.
std::vector<double> framePressures();
/// 0 to 8.7 kg in ten steps.
std::vector<double> frameLoadsKg();

enum class FrameWay { loading, unloading };

/// A muscle at rest in the frame.
struct FramePoint {
  double pressure_ratio = 0, length_mm = 0;
  double force_N = 0;  ///< weight of the load, or what a load cell at the held end reads
  double law_N = 0;    ///< F(p, l) at the same pressure and length
  FrameWay way = FrameWay::loading;
  bool at_rest = false;  ///< had come to rest when it was read
  int long_stop_count = 0, short_stop_count = 0, link_count = 0;
  /// All links at stops: the stops carry the load, the law says nothing about the length. As long as one link is free, the law decides.
  bool isStopped() const { return long_stop_count + short_stop_count == link_count; }
};

/// Loads hung one after another, from none to the heaviest and back, at each pressure; the muscle comes to rest under each. The load is
/// brought on slowly: whenever it is faster than before and slows down again, all bodies are stopped, so that it never swings past.
/// `parameters`: overrides, for example of friction or force law.
std::vector<FramePoint> loadSteps(const FrameSpecimen& specimen, const Parameters& parameters,
                                  const std::vector<double>& pressures = framePressures());

/// Lengths imposed one after another at each pressure, from the shortest to the longest and back in ten steps; the force is the one at the
/// held end.
std::vector<FramePoint> lengthSteps(const FrameSpecimen& specimen, const Parameters& parameters,
                                    const std::vector<double>& pressures = framePressures());

/// The paper's error function over points: sum (force - law)^2 / sum force^2.
double frameError(const std::vector<FramePoint>& points);

}  // namespace musclesim
