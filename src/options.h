/// Options that several sub-commands share: which model runs, on which physics, with which numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "laboratory/static_points.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::program {

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
  bool quiet = false, json = false;
};

/// Adds the model options to a command; all commands write into the same ModelOptions, so their place among the arguments is free.
void addModelOptions(CLI::App& command, ModelOptions& options);

/// An option of values that commas separate. What follows behind a space is no part of it, so that a file named there is not taken for one.
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values, const std::string& help);

/// The named parameters: --config first, then --muscles, --muscle and --joint-friction, then --set.
Parameters parametersFrom(const ModelOptions& options);

/// --substeps; 0 without it. Throws BadParameter for less than 1.
int substepsFrom(const ModelOptions& options);

/// The effects of --effects; none without it.
std::vector<ActiveEffect> effectsFrom(const ModelOptions& options);

/// How static points of a muscle are read from a table.
struct PointsOptions {
  std::vector<std::string> columns, where;
  std::optional<double> full_scale_kPa, censored_below_N;
};

/// They are refused without `table`, the option that names the table.
void addPointsOptions(CLI::App& command, CLI::Option& table, PointsOptions& options);

/// Throws BadParameter unless columns and rows are given as name=value.
StaticPointsOptions staticPointsOptions(const PointsOptions& options);

/// All of it, for a recording's plant.
ReplayOptions replayOptionsFrom(const ModelOptions& model);

/// One line to standard error, unless --quiet.
void say(const ModelOptions& options, const std::string& message);

}  // namespace musclesim::program
