/// The sub-commands. Each function adds its command to the command line and returns the function that runs it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "options.h"

namespace musclesim::command_line {

/// Exit statuses of the program; see the table in docs/user/getting_started.md.
enum ExitStatus {
  done = 0,
  internal_error = 1,
  bad_usage = 2,
  bad_input = 3,
  diverged = 4,
  io_error = 5,
  incomplete_sweep = 6,
  interrupted_base = 128
};

/// Runs a chosen command and returns the exit status; errors are thrown.
using Action = std::function<int()>;

/// `run`, which is also the default command: its options are added to both.
Action addRun(CLI::App& app, ModelOptions& model);
/// `schedule`: writes a test signal as a table of commands.
Action addSchedule(CLI::App& command, ModelOptions& model);
Action addReplay(CLI::App& command, ModelOptions& model);
/// `rerun`: repeats a run from its folder.
Action addRerun(CLI::App& command);
/// `figure`: draws signals of a recording.
Action addFigure(CLI::App& command, ModelOptions& model);
Action addDiagnose(CLI::App& command, ModelOptions& model);
/// `effects`: the catalogue of effects.
Action addEffects(CLI::App& command);
/// `robot`: checks, shows, begins, exports and imports robot files.
Action addRobot(CLI::App& command, ModelOptions& model);
/// `import`: turns measured tables into recordings.
Action addImport(CLI::App& command);
/// `experiment`: simulates the paper's load-frame experiment.
Action addExperiment(CLI::App& command, ModelOptions& model);
/// `fit`: force laws from measured static points.
Action addFit(CLI::App& command);
/// `plan`, `work`, `collect`: parameter sweeps over many processes or machines.
Action addPlan(CLI::App& command);
Action addWork(CLI::App& command);
Action addCollect(CLI::App& command);
/// `blind make|run|score`: the check of the diagnosis on withheld causes.
Action addBlind(CLI::App& command);
/// `bench`: real-time ratio over the number of muscles.
Action addBench(CLI::App& command, ModelOptions& model);

}  // namespace musclesim::command_line
