#include "force_stack.h"

#include <cmath>

namespace musclesim {

double ForceBelow::operator()(const MuscleInput& input) const {
  return stack_.at(level_, input);
}

void ForceStack::add(std::unique_ptr<ForceEffect> effect) {
  effects_.push_back(std::move(effect));
  seen_.emplace_back();
}

double ForceStack::at(std::size_t level, const MuscleInput& input) {
  if (level == 0) return actuator_.calculateForce(input.pressure_ratio, input.length_mm);
  seen_[level - 1] = input;
  return effects_[level - 1]->tensionN(input, ForceBelow(*this, level - 1));
}

void ForceStack::advance(double h_s) {
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    MuscleInput input = seen_[i];
    input.time.h_s = h_s;
    effects_[i]->advance(input);
  }
}

void ForceStack::reset() {
  for (const auto& effect : effects_) effect->reset();
}

void ForceStack::settle(const MuscleInput& input) {
  // The input of an effect depends on the states of the effects around it, so settling iterates. Two rounds suffice if at most one effect
  // has a state.
  constexpr int round_limit = 200;
  constexpr double accuracy = 1e-13;
  reset();
  double before = tensionN(input);
  for (int round = 0; round < round_limit; ++round) {
    for (std::size_t i = 0; i < effects_.size(); ++i) effects_[i]->settle(seen_[i]);
    const double now = tensionN(input);
    if (round > 0 && std::abs(now - before) <= accuracy * (1 + std::abs(now))) return;
    before = now;
  }
}

}  // namespace musclesim
