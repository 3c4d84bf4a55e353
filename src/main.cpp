/// The program `musclesim`: reads the command line, runs one command, turns errors into exit statuses.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/error.h"
#include "musclesim/version.h"

namespace {

using namespace musclesim;
using namespace musclesim::program;

int complain(const std::exception& error, ExitStatus status) {
  std::fprintf(stderr, "musclesim: error: %s\n", error.what());
  return status;
}

/// An empty value (--step "") would count as "not given".
void refuseEmptyValues(CLI::App& command) {
  for (CLI::Option* option : command.get_options())
    if (option->get_expected_max() > 0) option->check([](const std::string& value) { return value.empty() ? "must not be empty" : ""; });
}

int parseAndRun(int argument_count, char** arguments) {
  CLI::App app(
      "Simulator of robots driven by pneumatic artificial muscles.\n"
      "Without a sub-command it is `run`: the RoboticArm finds its height under attractor selection.");
  app.name("musclesim");
  app.set_version_flag("--version", "musclesim " MUSCLESIM_VERSION);
  app.footer(
      "Exit status: 0 done, 1 internal error, 2 usage, 3 bad input file, 4 simulation diverged,\n"
      "5 input/output error, 6 incomplete sweep, 130/143 interrupted (files complete up to then).");
  app.require_subcommand(0, 1);

  ModelOptions model;
  const program::Action run = addRun(app, model);
  CLI::App* replay_command = app.add_subcommand("replay", "Plays a recording's commands through the model and compares");
  const program::Action replay = addReplay(*replay_command, model);
  CLI::App* effects_command = app.add_subcommand("effects", "Lists the effects that a clean model leaves out, or describes one");
  const program::Action effects = addEffects(*effects_command);
  CLI::App* fit_command = app.add_subcommand("fit", "Fits force laws to measured static points");
  const program::Action fit = addFit(*fit_command);
  CLI::App* experiment_command = app.add_subcommand("experiment", "The paper's load-frame experiment in the simulator");
  const program::Action experiment = addExperiment(*experiment_command, model);
  CLI::App* bench_command = app.add_subcommand("bench", "Measures r(n), CPU time over simulated time, for all steppers and muscle models");
  const program::Action bench = addBench(*bench_command, model);
  for (CLI::App* command : {&app, replay_command, effects_command, fit_command, experiment_command, bench_command})
    refuseEmptyValues(*command);
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "musclesim: error: %s\nmusclesim --help lists the options\n", error.what());
    return bad_usage;
  }
  if (effects_command->parsed()) return effects();
  if (fit_command->parsed()) return fit();
  if (experiment_command->parsed()) return experiment();
  if (bench_command->parsed()) return bench();
  return replay_command->parsed() ? replay() : run();
}

}  // namespace

int main(int argument_count, char** arguments) {
  watchInterrupts();
  try {
    const int status = parseAndRun(argument_count, arguments);
    if (std::fflush(stdout) != 0) throw IoError("standard output: cannot be written");
    // After a caught fault of ODE its own cleanup may not run: leave without it.
    std::_Exit(status);
  } catch (const BadParameter& error) {
    std::_Exit(complain(error, bad_usage));
  } catch (const BadFile& error) {
    std::_Exit(complain(error, bad_input));
  } catch (const Diverged& error) {
    std::_Exit(complain(error, diverged));
  } catch (const IoError& error) {
    std::_Exit(complain(error, io_error));
  } catch (const std::filesystem::filesystem_error& error) {
    std::_Exit(complain(error, io_error));
  } catch (const std::exception& error) {
    std::_Exit(complain(error, internal_error));
  }
}
