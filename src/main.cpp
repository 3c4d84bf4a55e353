/// The program `musclesim`: reads the command line, runs one command, turns errors into exit statuses.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

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
  std::vector<std::pair<CLI::App*, program::Action>> commands;
  auto add = [&](const std::string& name, const std::string& description, auto addTo) {
    CLI::App* command = app.add_subcommand(name, description);
    commands.emplace_back(command, addTo(*command));
  };
  add("replay", "Plays a recording's commands through the model and compares",
      [&](CLI::App& command) { return addReplay(command, model); });
  add("effects", "Lists the effects that a clean model leaves out, or describes one", addEffects);
  add("fit", "Fits force laws to measured static points", addFit);
  add("experiment", "The paper's load-frame experiment in the simulator", [&](CLI::App& command) { return addExperiment(command, model); });
  add("bench", "Measures r(n), CPU time over simulated time, for all steppers and muscle models",
      [&](CLI::App& command) { return addBench(command, model); });
  add("diagnose", "Says where recordings differ from the model, why, and how far that can be closed",
      [&](CLI::App& command) { return addDiagnose(command, model); });
  add("plan", "Writes down the runs of a parameter sweep", addPlan);
  add("work", "Runs rows of a sweep that no other worker has taken, until none is left", addWork);
  add("collect", "Puts the results of a sweep into one table", addCollect);
  refuseEmptyValues(app);
  for (const auto& [command, action] : commands) refuseEmptyValues(*command);
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "musclesim: error: %s\nmusclesim --help lists the options\n", error.what());
    return bad_usage;
  }
  for (const auto& [command, action] : commands)
    if (command->parsed()) return action();
  return run();
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
