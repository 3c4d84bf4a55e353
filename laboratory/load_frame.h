/// Simulates the paper's load-frame experiment: measures a muscle's length under given loads and its force at given lengths.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// A muscle in the load frame. The paper measures a short, a medium and a long muscle without giving their lengths; ours are assumed.
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
  double force_N = 0;  ///< weight of the load, or the reading of a load cell at the held end
  double law_N = 0;    ///< F(p, l) at the same pressure and length
  FrameWay way = FrameWay::loading;
  bool at_rest = false;  ///< the muscle had come to rest when it was read
  int long_stop_count = 0, short_stop_count = 0, link_count = 0;
  /// True if all links are at stops: then the stops carry the load, and the length does not follow from the law. If any link is free, it
  /// does.
  bool isStopped() const { return long_stop_count + short_stop_count == link_count; }
};

/// Hangs loads one after another at each pressure, from none to the heaviest and back, and waits until the muscle rests under each. So that
/// the load never overshoots, all bodies are stopped whenever its speed has passed a maximum (kinetic damping).
/// `parameters`: overrides, for example of friction or force law.
std::vector<FramePoint> loadSteps(const FrameSpecimen& specimen, const Parameters& parameters,
                                  const std::vector<double>& pressures = framePressures());

/// Imposes lengths one after another at each pressure, from the shortest to the longest and back in ten steps each; reads the force at the
/// held end.
std::vector<FramePoint> lengthSteps(const FrameSpecimen& specimen, const Parameters& parameters,
                                    const std::vector<double>& pressures = framePressures());

/// The paper's error function over points: sum (force - law)^2 / sum force^2.
double frameError(const std::vector<FramePoint>& points);

}  // namespace musclesim
