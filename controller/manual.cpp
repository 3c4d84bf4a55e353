#include "musclesim/controller/manual.h"

#include <utility>

#include "musclesim/base/error.h"

namespace musclesim {

ManualController::ManualController(std::unique_ptr<Controller> automatic, int muscle_count, InputHistory repeated)
    : automatic_(std::move(automatic)), hands_(std::make_shared<Hands>(muscle_count, std::move(repeated))) {
  if (!automatic_) throw BadParameter("manual control: needs a controller to take over from");
}

Action ManualController::output(const State& state) {
  const UserInput before = std::exchange(input_, hands_->sample(state.time_s));
  if (input_.by_hand && !before.by_hand) intervals_.push_back({state.time_s, state.time_s});
  if (before.by_hand) intervals_.back().to_s = state.time_s;
  if (input_.target_mm && input_.target_mm != before.target_mm) automatic_->moveTarget(*input_.target_mm);
  if (input_.by_hand) return input_.pressures;
  const Action commanded = automatic_->output(state);
  hands_->note(commanded);
  return commanded;
}

}  // namespace musclesim
