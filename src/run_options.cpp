/// The options of `musclesim run`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "musclesim/controller/controller_registry.h"
#include "run.h"

namespace musclesim::command_line {

namespace {

constexpr const char* run_group = "Run";

/// What is commanded.
void addControlOptions(CLI::App& command, RunOptions& options) {
  command
      .add_option("--controller", options.controller,
                  fmt::format("Controller: {} (default: asm for the arm or with a task, else triangle; schedule with --commands)",
                              fmt::join(registeredControllers(), ", ")))
      ->group(run_group);
  command
      .add_option("--commands", options.commands, "Commands for --controller schedule: a recording, or a table with time_s and command_<i>")
      ->group(run_group);
  command
      .add_option("--interpolate", options.interpolate,
                  "Commands between two rows; hold: those of the earlier row (default); linear: on the straight line")
      ->group(run_group)
      ->check(CLI::IsMember({"hold", "linear"}));
  command
      .add_option("--channels", options.channels,
                  "What a test signal or the position controller moves: muscles 0,1, antagonists 0:1, groups elbow=0+2:1+3 (default: the "
                  "robot's antagonists, else all muscles)")
      ->group(run_group)
      ->option_text("CHANNEL,...");
  command
      .add_option("--targets", options.targets, "Targets for --controller position: a table with time_s and angles or the hand's height")
      ->group(run_group);
  command.add_option("--task", options.task, "height: bring the hand to a height (default); reach: bring it to a point")->group(run_group);
  command.add_option("--target", options.target_mm, "X,Y,Z of the target in mm (for the height task only Y counts)")
      ->group(run_group)
      ->delimiter(',')
      ->expected(3);
  command
      .add_option("--decision-interval", options.decision_interval_s,
                  "Time between decisions in s (default: 3 in si, 6 in original, 0.19 in scaled physics)")
      ->group(run_group);
}

/// What is written, and what the verdict says of it.
void addRecordOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--record", options.record, "Recording to write, FILE.csv (default: run.csv in the run's folder)")->group(run_group);
  command
      .add_option("--record-interval", options.record_interval_s,
                  "Time between recorded rows in s, rounded to whole steps (default: every step)")
      ->group(run_group);
  addList(command, "--record-signals", options.record_signals,
          "Signals to record beside the commands (default: all); NAME_per_s and NAME_per_s2 are velocity and acceleration")
      ->group(run_group);
  addList(command, "--figure-signals", options.figure_signals, "Signals in the figure; NAME* stands for all that begin so")
      ->group(run_group);
  addList(command, "--summarise", options.summarise,
          "Signals whose last value, mean, peak, trough, settling time and overshoot are printed and stand in the verdict")
      ->group(run_group);
  command.add_option("--against", options.against, "Recording from which the summarised signals' RMSE is computed")->group(run_group);
  command.add_option("--out", options.out, "Folder of the run (default: log/runs/<date-time>-<task>-<seed>)")->group(run_group);
  command.add_flag("--overwrite", options.overwrite, "Replace a finished run in the folder of --out")->group(run_group);
}

}  // namespace

void addRunOptions(CLI::App& command, RunOptions& options) {
  command.add_flag("--simple", options.simple, "Batch run without window or interaction (default: a window opens)")->group(run_group);
  command.add_flag("--verbose", options.verbose, "List all primitives and actuators on standard output")->group(run_group);
  addControlOptions(command, options);
  command
      .add_option(
          "--duration", options.duration_s,
          "Simulated time in s (default: until the window is closed; without one to the end of the commands, else 300 with --simple "
          "and 20 with --screenshot or --video)")
      ->group(run_group);
  addRecordOptions(command, options);
  command.add_flag("--print-config", options.print_config, "Print all parameters as TOML and exit")->group(run_group);
  command
      .add_option("--window-log", options.window_log,
                  "Log the user's actions in the window to FILE: one line of JSON per key or click, with the state after it")
      ->group("Pictures");
  addPictureOptions(command, options.pictures, "Pictures");
}

}  // namespace musclesim::command_line
