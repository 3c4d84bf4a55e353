#include "musclesim/controller/hands.h"

#include <algorithm>
#include <string>

#include "musclesim/base/error.h"

namespace musclesim {

UserInput InputHistory::at(long step) const {
  const auto later =
      std::upper_bound(changes.begin(), changes.end(), step, [](long number, const auto& change) { return number < change.first; });
  return later == changes.begin() ? UserInput{} : std::prev(later)->second;
}

Hands::Hands(int muscle_count, InputHistory repeated) : repeated_(std::move(repeated)) {
  if (muscle_count < 1) throw BadParameter("muscles of manual control", std::to_string(muscle_count), "be at least 1");
  now_.pressures.assign(static_cast<std::size_t>(muscle_count), 0.0);
}

void Hands::takeOver() {
  const std::lock_guard lock(access_);
  now_.by_hand = true;
}

void Hands::handBack() {
  const std::lock_guard lock(access_);
  now_.by_hand = false;
}

bool Hands::isManual() const {
  const std::lock_guard lock(access_);
  return now_.by_hand;
}

void Hands::set(int muscle, double pressure_ratio) {
  const std::lock_guard lock(access_);
  if (muscle < 0 || muscle >= static_cast<int>(now_.pressures.size()))
    throw BadParameter("muscle", std::to_string(muscle), "lie in 0 .. " + std::to_string(now_.pressures.size() - 1));
  now_.by_hand = true;
  now_.pressures[static_cast<std::size_t>(muscle)] = std::clamp(pressure_ratio, 0.0, 1.0);
}

void Hands::reset() {
  const std::lock_guard lock(access_);
  now_.by_hand = true;
  std::ranges::fill(now_.pressures, 0.0);
}

Action Hands::pressures() const {
  const std::lock_guard lock(access_);
  return now_.pressures;
}

void Hands::moveTarget(const Vector& target_mm) {
  const std::lock_guard lock(access_);
  now_.target_mm = target_mm;
}

std::optional<Vector> Hands::movedTargetMm() const {
  const std::lock_guard lock(access_);
  return now_.target_mm;
}

void Hands::pull(const std::optional<Pull>& pull) {
  const std::lock_guard lock(access_);
  now_.pull = pull;
}

UserInput Hands::sample(double time_s) {
  const std::lock_guard lock(access_);
  const long step = history_.step_count++;
  history_.time_s = time_s;
  if (step < repeated_.step_count) {
    UserInput before = repeated_.at(step);
    if (!before.by_hand) before.pressures = now_.pressures;
    now_ = std::move(before);
  }
  UserInput input = now_;
  if (!input.by_hand) input.pressures.clear();
  if (history_.changes.empty() ? input != UserInput{} : input != history_.changes.back().second) history_.changes.emplace_back(step, input);
  if (step + 1 == repeated_.step_count) now_.pull.reset();  // nobody holds it any more
  return input;
}

void Hands::note(const Action& commanded) {
  const std::lock_guard lock(access_);
  if (!now_.by_hand) now_.pressures = commanded;
}

InputHistory Hands::history() const {
  const std::lock_guard lock(access_);
  return history_;
}

bool Hands::isRepeating() const {
  const std::lock_guard lock(access_);
  return history_.step_count < repeated_.step_count;
}

}  // namespace musclesim
