#include "run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/simulation/run_loop.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace fs = std::filesystem;

namespace {

std::string taskOf(const RunOptions& options) {
  return options.task.value_or("height");
}

}  // namespace

std::string defaultController(const Robot& robot, const RunOptions& options) {
  return musclesim::defaultController(robot, options.task || !options.target_mm.empty());
}

fs::path recordingPath(const RunOptions& options, Simulation& simulation) {
  if (options.record) return *options.record;
  const bool has_task = simulation.controller() && simulation.controller()->targetMm();
  const std::string label = has_task ? taskOf(options) : simulation.robot().name() + "-" + *options.controller;
  return (options.out ? fs::path(*options.out) : freshFolder(fmt::format("{}-{}", label, simulation.seed()))) / "run.csv";
}

RecordingInfo describe(Simulation& simulation, const RunOptions& options, const std::string& initial_state, const nlohmann::json& origin) {
  RecordingInfo info = describeModel(simulation, initial_state);
  info.description = fmt::format("{} under {}", info.robot, *options.controller);
  nlohmann::json extra = nlohmann::json::parse(info.extra_json);
  extra["controller"] = *options.controller;
  // Without a target there is no task.
  if (simulation.controller() && simulation.controller()->targetMm()) {
    info.description += fmt::format(", {} task", taskOf(options));
    extra["task"] = taskOf(options);
  }
  if (!origin.is_null()) extra["run"] = origin;
  info.extra_json = extra.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);  // arguments may be no UTF-8
  return info;
}

/// Prints all primitives and actuators, as the paper's --verbose does.
void list(Simulation& simulation) {
  for (const auto& primitive : simulation.world().primitives()) {
    const Vector p = primitive->getPosition();
    fmt::print("primitive {}: {} g, centre of mass of its body at ({:.3f}, {:.3f}, {:.3f}) mm\n", primitive->name(), primitive->massG(),
               p.x(), p.y(), p.z());
  }
  for (const auto& actuator : simulation.world().actuators())
    fmt::print("actuator {}: {} links, {:.3f} mm, {} .. {} mm{}{}\n", actuator->name(), actuator->links().size(), actuator->lengthMm(),
               actuator->minimumLengthMm(), actuator->maximumLengthMm(), actuator->color().name.empty() ? "" : ", ",
               actuator->color().name);
}

void Score::add(double time_s, const State& state, const Controller& controller) {
  const auto target = controller.targetMm();
  if (!target || !state.hand_mm) return;
  error_mm_ = controller.targetIsHeight() ? std::abs(state.hand_mm->y() - target->y()) : (*state.hand_mm - *target).norm();
  const bool near = *error_mm_ <= near_mm;
  if (near && !reached_at_s_) reached_at_s_ = time_s;
  if (!reached_at_s_) return;
  ++samples_since_;
  near_since_ += near;
}

nlohmann::json Score::verdict() const {
  nlohmann::json json;
  if (!error_mm_) return json;
  json["final_error_mm"] = *error_mm_;
  json["reached_within_mm"] = near_mm;
  json["reached_at_s"] = reached_at_s_ ? nlohmann::json(*reached_at_s_) : nlohmann::json(nullptr);
  json["held_share"] = samples_since_ ? static_cast<double>(near_since_) / static_cast<double>(samples_since_) : 0.0;
  return json;
}

}  // namespace musclesim::command_line
