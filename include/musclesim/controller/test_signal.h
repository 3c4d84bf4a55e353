/// Test signals: steps, ramps, sines and the like, as commands.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "musclesim/controller/channels.h"
#include "musclesim/controller/controller.h"

namespace musclesim {

/// One kind of test signal. Every kind is a controller of that name.
struct TestSignalInfo {
  std::string name, description;
};

/// steps, ramp, triangle, sine, chirp, prbs, multisine, staircase, reversals.
const std::vector<TestSignalInfo>& testSignals();

/// Commands a signal s(t), -1 <= s <= 1, evaluated by its formula at State::time_s, so calls may come in any order:
///     p_i(t) = level_i + sum over channels k of c_ik A_k s_k(t - t_0 - k shift),   s = 0 before its beginning
/// p_i command of muscle i, fraction of full scale; level_i NAME.level_<i> (default NAME.level); A_k NAME.amplitude_<k> (default
/// NAME.amplitude); t_0 NAME.start_s; shift NAME.shift_s. c_ik is 1 for muscles of channel k that rise; for those that fall it is -1 if
/// NAME.drive is "difference" and 1 if it is "co_contraction"; 0 for all others, which keep their level.
///
/// Channels are those of the request; else the robot's antagonists (antagonistsOf); else every muscle is a channel, and all move together.
/// The shape's own parameters and formulas: docs/reference/controllers.md, waves.h.
class TestSignalController final : public Controller {
 public:
  /// Throws BadParameter for an unknown name, for parameters out of range, and where commands could leave 0..1.
  TestSignalController(const std::string& name, const ControllerRequest& request);
  Action output(const State& state) override;
  std::vector<std::string> notes() const override;

  const std::vector<Channel>& channels() const { return channels_; }

 private:
  void requireRange(const std::string& name) const;

  std::vector<Channel> channels_;
  std::vector<std::function<double(double)>> shapes_;  ///< s_k
  std::vector<double> level_, amplitude_;
  std::vector<std::vector<double>> sense_;  ///< c_ik, [channel][muscle]
  double start_s_, shift_s_;
};

}  // namespace musclesim
