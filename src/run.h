/// Runs of a robot under a controller, for `run` and for `rerun`.
#pragma once

#include <CLI/CLI.hpp>

#include "run_output.h"

namespace musclesim::command_line {

/// Adds the options of `run`, except the model options.
void addRunOptions(CLI::App& command, RunOptions& options);

/// Runs and returns the exit status.
int run(const ModelOptions& model, const RunOptions& options);

/// Whether these options open a window.
bool hasWindow(const RunOptions& options);

}  // namespace musclesim::command_line
