#include "options.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"
#include "musclesim/effect/effects_file.h"
#include "plugin.h"

namespace musclesim::command_line {

namespace {

std::pair<std::string, std::string> splitAssignment(const std::string& option, const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size())
    throw BadParameter(option, assignment, "have the form name=value");
  return {assignment.substr(0, equals), assignment.substr(equals + 1)};
}

}  // namespace

void addModelOptions(CLI::App& command, ModelOptions& options) {
  const std::string model = "Model";
  command
      .add_option("--robot", options.robot,
                  "Robot: a file NAME.toml, or arm, rig, elbow, wrist, pulley_arm, spring_bench or a plugin's robot (default: the "
                  "recording's, else arm)")
      ->group(model);
  command
      .add_option_function<std::vector<std::string>>(
          plugin_option,
          [&options](const std::vector<std::string>& files) {
            std::ranges::for_each(files, loadPlugin);
            options.plugins.insert(options.plugins.end(), files.begin(), files.end());
          },
          "Shared library with robots, controllers or effects in C++: LIBRARY.so; may be repeated")
      ->group(model)
      ->take_all()
      ->trigger_on_parse();
  command
      .add_option("--physics", options.physics,
                  "si: true seconds; original: the published program's units; scaled: its constants in true units (default: the "
                  "recording's, else si)")
      ->group(model);
  command
      .add_option("--initial-state", options.initial_state, "built: the pose as built; settled: at equilibrium (default: the robot's own)")
      ->group(model)
      ->check(CLI::IsMember({"built", "settled"}));
  command.add_option("--stepper", options.stepper, "auto, chain, ode (dWorldStep) or quick (dWorldQuickStep)")
      ->group(model)
      ->capture_default_str();
  command.add_option("--step", options.step_s, "Control and logging step in s (default: the recording's, else 0.01)")->group(model);
  command.add_option("--substeps", options.substeps, "Internal steps per control step (default: as many as the stepper needs)")
      ->group(model);
  command.add_option("--muscles", options.muscle_count, "Number of muscles of the arm, 1 .. 30 (default 10)")->group(model);
  command.add_option("--muscle", options.muscle, "chain: chains of beads (default); line: massless straight lines, much faster")
      ->group(model);
  command
      .add_option("--joint-friction", options.joint_friction,
                  "Friction of the chains' joints; coulomb: dry (default); viscous: grows with the speed, faster to compute")
      ->group(model);
  command.add_flag("--plane", options.plane, "Add a ground plane")->group(model);
  command.add_option("--seed", options.seed, "Seed of all random numbers (default: the recording's, else 1)")
      ->group(model)
      ->check([](const std::string& value) {
        std::uint64_t seed = 0;
        const auto end = value.data() + value.size();
        const auto read = std::from_chars(value.data(), end, seed);
        return read.ec == std::errc() && read.ptr == end ? "" : "must be a whole number in 0 .. 18446744073709551615";
      });
  command.add_option("--set", options.set, "Override one named parameter; may be repeated")
      ->group(model)
      ->allow_extra_args(false)
      ->option_text("NAME=VALUE");
  command.add_option("--config", options.config, "TOML file with named parameters")->group(model);
  command.add_option("--effects", options.effects, "JSON file with effects to add to the model (musclesim effects lists them)")
      ->group(model);
  command.add_flag("--quiet", options.quiet, "No messages on standard error except errors")->group(model);
  command.add_flag("--json", options.json, "Print the verdict as one JSON object, the last line of standard output")->group(model);
}

CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values, const std::string& help) {
  return command.add_option(name, values, help)->delimiter(',')->allow_extra_args(false)->option_text("VALUE,...");
}

Parameters parametersFrom(const ModelOptions& options) {
  Parameters parameters;
  if (options.config) parameters.readToml(*options.config);
  if (options.muscle_count) parameters.set("arm.muscle_count", static_cast<double>(*options.muscle_count), "--muscles");
  if (options.muscle) parameters.set("muscle.model", *options.muscle, "--muscle");
  if (options.joint_friction) parameters.set("muscle.joint_friction", *options.joint_friction, "--joint-friction");
  for (const auto& assignment : options.set) parameters.setFromText(assignment, "--set");
  return parameters;
}

int substepsFrom(const ModelOptions& options) {
  if (options.substeps && *options.substeps < 1) throw BadParameter("substeps", std::to_string(*options.substeps), "be at least 1");
  return options.substeps.value_or(0);
}

std::vector<ActiveEffect> effectsFrom(const ModelOptions& options) {
  return options.effects ? readEffects(*options.effects) : std::vector<ActiveEffect>();
}

void addPointsOptions(CLI::App& command, CLI::Option& table, PointsOptions& options) {
  const std::string needed = " Needs: " + table.get_name();
  command
      .add_option("--mapping", options.mapping,
                  "How the table is written, and which columns hold pressure, length and force: MAPPING.toml, as for import")
      ->needs(&table);
  addList(command, "--columns", options.columns,
          "Columns that hold pressure, length or force under another name; NAME:unit gives the unit (else fraction, mm, N); #3 is the "
          "third column")
      ->needs(&table)
      ->option_text("pressure=NAME,length=NAME,force=NAME" + needed);
  addList(command, "--where", options.where, "Use only rows with this value in this column; may be repeated")
      ->needs(&table)
      ->option_text("COLUMN=VALUE,..." + needed);
  command.add_option("--full-scale-kPa", options.full_scale_kPa, "Pressure in kPa that counts as 1 (default: the largest in the file)")
      ->check(CLI::Range(1.0, 1e4))
      ->needs(&table);
  command
      .add_option("--censored-below", options.censored_below_N,
                  "The force sensor reads nothing below this force in N (default: the lowest force, if it occurs repeatedly)")
      ->needs(&table);
}

StaticPointsOptions staticPointsOptions(const PointsOptions& options) {
  StaticPointsOptions result;
  result.mapping = options.mapping;
  for (const auto& column : options.columns) result.columns.push_back(splitAssignment("--columns", column));
  for (const auto& filter : options.where) result.where.push_back(splitAssignment("--where", filter));
  result.full_scale_kPa = options.full_scale_kPa;
  result.censored_below_N = options.censored_below_N;
  return result;
}

ReplayOptions replayOptionsFrom(const ModelOptions& model) {
  ReplayOptions options;
  options.robot = model.robot;
  options.initial_state = model.initial_state;
  if (model.physics) options.physics = physicsFromName(*model.physics);
  options.step_s = model.step_s;
  options.stepper = stepperFromName(model.stepper);
  options.substeps = substepsFrom(model);
  options.plane = model.plane;
  options.seed = model.seed;
  options.parameters = parametersFrom(model);
  options.effects = effectsFrom(model);
  return options;
}

void tell(const std::string& message) {
  std::fprintf(stderr, "musclesim: %s\n", printable(message).c_str());
}

void say(const ModelOptions& options, const std::string& message) {
  if (!options.quiet) tell(message);
}

}  // namespace musclesim::command_line
