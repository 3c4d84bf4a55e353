/// Options that several sub-commands share: robot, physics, stepper and parameters of the model.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "laboratory/static_points.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::command_line {

inline constexpr const char* plugin_option = "--plugin";

/// As given on the command line; empty optionals mean "not given".
struct ModelOptions {
  std::optional<std::string> robot, physics, initial_state;
  std::string stepper = "auto";
  std::optional<double> step_s;
  std::optional<int> substeps, muscle_count;
  bool plane = false;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> muscle, joint_friction;
  std::vector<std::string> set;
  std::optional<std::string> config, effects;
  std::vector<std::string> plugins;  ///< libraries of --plugin; they are loaded when the option is read
  bool quiet = false, json = false;
  std::string command_line;            ///< all arguments, as one would type them
  std::vector<std::string> arguments;  ///< without the sub-command
};

/// Adds the model options to a command; all commands write into the same ModelOptions, so their place among the arguments is free.
void addModelOptions(CLI::App& command, ModelOptions& options);

/// Adds an option with values separated by commas. An argument after a space does not belong to it, so that a file name may follow.
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values, const std::string& help);

/// The named parameters: --config first, then --muscles, --muscle and --joint-friction, then --set.
Parameters parametersFrom(const ModelOptions& options);

/// The value of --substeps, or 0 if it is not given. Throws BadParameter for less than 1.
int substepsFrom(const ModelOptions& options);

/// The effects in the file of --effects; none if it is not given.
std::vector<ActiveEffect> effectsFrom(const ModelOptions& options);

/// How static points of a muscle are read from a table.
struct PointsOptions {
  std::string mapping;
  std::vector<std::string> columns, where;
  std::optional<double> full_scale_kPa, censored_below_N;
};

/// Adds the options for reading points. They need the option `table`, which names the file.
void addPointsOptions(CLI::App& command, CLI::Option& table, PointsOptions& options);

/// Throws BadParameter unless columns and rows are given as name=value.
StaticPointsOptions staticPointsOptions(const PointsOptions& options);

/// All model options together, for the plant of a recording.
ReplayOptions replayOptionsFrom(const ModelOptions& model);

/// One line to standard error, without control characters.
void tell(const std::string& message);

/// The same, unless --quiet.
void say(const ModelOptions& options, const std::string& message);

}  // namespace musclesim::command_line
