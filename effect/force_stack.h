/// The force law of one muscle with the effects that enclose it.
#pragma once

#include <memory>
#include <vector>

#include "musclesim/effect/effect.h"
#include "musclesim/robot/actuator.h"

namespace musclesim {

class ForceStack {
 public:
  explicit ForceStack(const Actuator& actuator) : actuator_(actuator) {}
  /// The next effect encloses all before it.
  void add(std::unique_ptr<ForceEffect> effect);
  bool empty() const { return effects_.empty(); }

  double tensionN(const MuscleInput& input) { return at(effects_.size(), input); }
  /// Moves all states on by h_s from what they saw in the last tensionN.
  void advance(double h_s);
  void reset();
  /// The states when everything has been as in `input` for ever.
  void settle(const MuscleInput& input);

 private:
  friend class ForceBelow;
  double at(std::size_t level, const MuscleInput& input);

  const Actuator& actuator_;
  std::vector<std::unique_ptr<ForceEffect>> effects_;
  std::vector<MuscleInput> seen_;  ///< by each effect, last
};

}  // namespace musclesim
