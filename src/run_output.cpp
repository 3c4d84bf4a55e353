#include "run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "musclesim/error.h"
#include "musclesim/version.h"
#include "output_folder.h"

namespace musclesim::program {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 4> model_groups = {"physics.", "muscle.", "force_law.", "world."};

nlohmann::json toJson(const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::get<std::string>(value);
}

/// What a replay needs to rebuild the robot: its own parameters, and all others of the model that differ from their defaults.
std::map<std::string, Parameter::Value> robotParameters(Simulation& simulation) {
  std::map<std::string, Parameter::Value> result;
  const std::string own = simulation.robot().name() + ".";
  // Controllers and tasks have parameters too, but a replay has neither.
  const auto belongsToModel = [](const std::string& name) {
    return std::any_of(model_groups.begin(), model_groups.end(), [&](const char* group) { return name.starts_with(group); });
  };
  for (const Parameter& p : simulation.parameters().declared()) {
    if (p.name.starts_with(own))
      result[p.name.substr(own.size())] = p.value;
    else if (belongsToModel(p.name) && p.value != p.default_value)
      result[p.name] = p.value;
  }
  return result;
}

}  // namespace

fs::path recordingPath(const RunOptions& options, std::uint64_t seed) {
  const fs::path file = options.record
                            ? fs::path(*options.record)
                            : (options.out ? fs::path(*options.out) : freshFolder(fmt::format("{}-{}", options.task, seed))) / "run.csv";
  if (file.extension() != ".csv") throw BadParameter("record", file.string(), "end in .csv");
  return file;
}

RecordingInfo describe(Simulation& simulation, const RunOptions& options, const std::string& initial_state) {
  RecordingInfo info;
  info.robot = simulation.robot().name();
  info.physics = nameOf(simulation.physics().kind);
  info.initial_state = initial_state;
  info.robot_parameters = robotParameters(simulation);
  info.description = fmt::format("{} under {}, {} task", info.robot, options.controller, options.task);
  info.active_effects = simulation.effects().active();
  info.noise_std = simulation.effects().noise();
  info.seed = simulation.seed();
  info.step_s = simulation.stepS();
  info.program = "musclesim " MUSCLESIM_VERSION;
  nlohmann::json extra;
  extra["controller"] = options.controller;
  extra["task"] = options.task;
  extra["stepper"] = simulation.stepper().name();
  extra["substeps"] = simulation.substeps();
  extra["internal_step_s"] = simulation.internalStepS();
  for (const Parameter& p : simulation.parameters().declared()) extra["parameters"][p.name] = toJson(p.value);
  info.extra_json = extra.dump();
  return info;
}

/// The listing of the paper's --verbose: all primitives and actuators.
void list(Simulation& simulation) {
  for (const auto& primitive : simulation.primitives()) {
    const Vector p = primitive->getPosition();
    fmt::print("primitive {}: {} g, centre of mass of its body at ({:.3f}, {:.3f}, {:.3f}) mm\n", primitive->name(), primitive->massG(),
               p.x(), p.y(), p.z());
  }
  for (const auto& actuator : simulation.actuators())
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

}  // namespace musclesim::program
