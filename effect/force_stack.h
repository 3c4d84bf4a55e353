/// The force law of one muscle and the force effects around it, nested like shells.
#pragma once

#include <memory>
#include <vector>

#include "musclesim/effect/effect.h"
#include "musclesim/robot/actuator.h"

namespace musclesim {

class ForceStack {
 public:
  explicit ForceStack(const Actuator& actuator) : actuator_(actuator) {}
  /// Adds an effect around all effects added before.
  void add(std::unique_ptr<ForceEffect> effect);
  bool empty() const { return effects_.empty(); }

  double tensionN(const MuscleInput& input) { return at(effects_.size(), input); }
  /// Advances the states of all effects by h_s, with the inputs of the last tensionN().
  void advance(double h_s);
  void reset();
  /// Sets the states to their steady values for a constant `input`.
  void settle(const MuscleInput& input);

 private:
  friend class ForceBelow;
  double at(std::size_t level, const MuscleInput& input);

  const Actuator& actuator_;
  std::vector<std::unique_ptr<ForceEffect>> effects_;
  std::vector<MuscleInput> seen_;  ///< last input of each effect
};

}  // namespace musclesim
