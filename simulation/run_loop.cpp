#include "musclesim/simulation/run_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../log/row_text.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

constexpr double longest_s = 1e7;

}  // namespace

double defaultDecisionIntervalS(const PhysicsSettings& physics) {
  constexpr double original_s = 6.0, si_s = 3.0;
  if (physics.kind == PhysicsKind::si) return si_s;
  return physics.kind == PhysicsKind::original ? original_s : original_s / std::sqrt(original_force_deficit_ratio);
}

std::string defaultController(const Robot& robot, bool has_task) {
  return robot.name() == "arm" || has_task ? "asm" : "triangle";
}

double defaultDurationS(const Controller& controller) {
  constexpr double published_s = 300;
  return controller.endS().value_or(published_s);
}

ControllerRequest controllerRequest(Simulation& simulation, const std::string& task, const std::optional<double>& decision_interval_s) {
  const double interval_s = decision_interval_s.value_or(defaultDecisionIntervalS(simulation.physics()));
  if (!(interval_s > 0 && std::isfinite(interval_s)))
    throw BadParameter("decision-interval", fmt::format("{} s", interval_s), "be positive and finite");
  ControllerRequest request{simulation.parameters()};
  request.muscle_count = simulation.robot().actuatorCount();
  request.step_s = simulation.stepS();
  request.decision_interval_s = interval_s;
  request.seed = simulation.seed();
  request.task = task;
  request.robot = &simulation.robot();
  return request;
}

std::vector<std::string> runColumns(const Robot& robot, const Controller& controller) {
  std::vector<std::string> names = robot.signalNames();
  if (controller.targetMm())
    for (const char* axis : {"x", "y", "z"})
      if (!controller.targetIsHeight() || *axis == 'y') names.push_back(fmt::format("target_{}_mm", axis));
  if (controller.activity()) names.push_back("activity");
  for (const auto& [name, value] : controller.signals()) names.push_back(name);
  static_cast<void>(RowText(names));  // refuses names that no recording can have
  return names;
}

std::vector<double> runRow(const Robot& robot, const Controller& controller, const State& state) {
  std::vector<double> values = robot.signalValues(state);
  if (const auto target = controller.targetMm()) {
    if (controller.targetIsHeight())
      values.push_back(target->y());
    else
      values.insert(values.end(), target->data(), target->data() + 3);
  }
  if (const auto activity = controller.activity()) values.push_back(*activity);
  for (const auto& [name, value] : controller.signals()) values.push_back(value);
  return values;
}

void RunLoop::requireTimes(double step_s) const {
  if (!(duration_s >= step_s && duration_s <= longest_s))
    throw BadParameter("duration", fmt::format("{} s", duration_s), fmt::format("lie between one step, {} s, and 1e7 s", step_s));
  if (record_interval_s && !(*record_interval_s > 0 && std::isfinite(*record_interval_s)))
    throw BadParameter("record-interval", fmt::format("{} s", *record_interval_s), "be positive and finite");
}

void runLoop(Simulation& simulation, Controller& controller, Action first_command, const RunLoop& loop) {
  Action action = std::move(first_command);
  Robot& robot = simulation.robot();
  const double step_s = simulation.stepS();
  const long step_count = std::lround(loop.duration_s / step_s);
  const long record_every = std::max(1L, std::lround(loop.record_interval_s.value_or(step_s) / step_s));
  for (long i = 0; i < step_count && (!loop.goes_on || loop.goes_on()); ++i) {
    const bool is_due = i % record_every == 0;
    if (i > 0) {
      const Action before = std::exchange(action, controller.output(robot.getState()));
      if (!is_due && action != before && loop.command_is_late) loop.command_is_late(static_cast<double>(record_every) * step_s);
    }
    robot.step(action);
    loop.row(robot.getState(), is_due);
    simulation.step();
    if (loop.after_step) loop.after_step();
  }
  // The last row, too, has the command and the forces of its own time.
  robot.step(simulation.stepCount() > 0 ? controller.output(robot.getState()) : action);
  loop.row(robot.getState(), true);
}

}  // namespace musclesim
