#include "command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "../evaluation/out_of_catalogue/out_of_catalogue.h"
#include "musclesim/base/parameters.h"
#include "musclesim/version.h"

namespace musclesim::command_line {

namespace {

/// Refuses empty values (--step ""), which would count as not given; also in sub-commands.
void refuseEmptyValues(CLI::App& command) {
  for (CLI::App* below : command.get_subcommands({})) refuseEmptyValues(*below);
  for (CLI::Option* option : command.get_options())
    if (option->get_expected_max() > 0) option->check([](const std::string& value) { return value.empty() ? "must not be empty" : ""; });
}

}  // namespace

CommandLine::CommandLine()
    : app_(
          "Simulator of robots driven by pneumatic artificial muscles.\n"
          "Without a sub-command it does `run`: attractor selection lifts the RoboticArm's hand to a height.") {
  app_.name("musclesim");
  app_.set_version_flag("--version", "musclesim " MUSCLESIM_VERSION);
  app_.footer(
      "Exit status: 0 done, 1 internal error, 2 usage, 3 bad input file, 4 simulation diverged,\n"
      "5 input/output error, 6 incomplete sweep, 130/143 interrupted (the files hold everything up to then).");
  app_.require_subcommand(0, 1);

  run_ = addRun(app_, model_);
  const auto add = [&](const std::string& name, const std::string& description, auto addTo) {
    CLI::App* command = app_.add_subcommand(name, description);
    commands_.emplace_back(command, addTo(*command));
  };
  add("schedule", "Writes a test signal as a table of commands, for a machine or for run --commands",
      [&](CLI::App& command) { return addSchedule(command, model_); });
  add("replay", "Simulates a recording's commands and compares the result with its measurements",
      [&](CLI::App& command) { return addReplay(command, model_); });
  add("rerun", "Repeats a run from its folder alone and says whether the bytes are the same", addRerun);
  add("figure", "Draws signals of a recording over time", [&](CLI::App& command) { return addFigure(command, model_); });
  add("robot", "Checks, shows, begins, exports or imports a robot file", [&](CLI::App& command) { return addRobot(command, model_); });
  add("import", "Turns a table of measurements into a recording", addImport);
  add("effects", "Lists the effects that can be added to the model, or describes one", addEffects);
  add("fit", "Fits force laws to measured static points", addFit);
  add("experiment", "Simulates the paper's load-frame experiment", [&](CLI::App& command) { return addExperiment(command, model_); });
  add("bench", "Measures CPU time over simulated time, r(n), for n muscles, all steppers and muscle models",
      [&](CLI::App& command) { return addBench(command, model_); });
  add("diagnose", "Finds where recordings differ from the model, which effect explains it, and how much of the gap that closes",
      [&](CLI::App& command) { return addDiagnose(command, model_); });
  add("blind", "Checks the diagnosis on recordings whose cause is withheld", addBlind);
  add("plan", "Prepares the runs of a parameter sweep", addPlan);
  add("work", "Runs those rows of a sweep that no other worker has taken, until none is left", addWork);
  add("collect", "Puts the results of a sweep into one table", addCollect);
  refuseEmptyValues(app_);
  registerOutOfCatalogueLaws();  // so that recordings made by the check of the diagnosis can be replayed
}

std::vector<std::string> CommandLine::commandNames() const {
  std::vector<std::string> names;
  for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
  return names;
}

/// Moves the sub-command to the front, since options before it are meant for it.
std::vector<std::string> CommandLine::ordered(std::vector<std::string> arguments) const {
  const std::vector<std::string> names = commandNames();
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const CLI::Option* before = i > 0 ? app_.get_option_no_throw(arguments[i - 1]) : nullptr;
    const bool is_value = before && before->get_expected_max() > 0;
    if (is_value || std::ranges::find(names, arguments[i]) == names.end()) continue;
    std::rotate(arguments.begin(), arguments.begin() + static_cast<std::ptrdiff_t>(i),
                arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    break;
  }
  return arguments;
}

/// The message of a usage error. Unexpected words are listed in the order given, with the command that was probably meant.
std::string CommandLine::messageFor(const CLI::ParseError& error) const {
  if (!dynamic_cast<const CLI::ExtrasError*>(&error)) return error.what();
  const std::vector<std::string> words = app_.remaining(true);
  std::string message = fmt::format("not expected here: {}", fmt::join(words, " "));
  if (words.empty() || words.front().starts_with('-') || !app_.get_subcommands().empty()) return message;
  const std::vector<std::string> names = commandNames();
  const std::string nearest = nearestName(words.front(), names);
  return message + (nearest.empty() ? fmt::format("; commands are {}", fmt::join(names, ", ")) : "; did you mean " + nearest + "?");
}

namespace {

/// An argument as one would type it in a shell.
std::string shellWord(const std::string& argument) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string quoted = "'";
  for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::optional<int> CommandLine::parse(int argument_count, const char* const* arguments) {
  model_.command_line = "musclesim";
  for (int i = 1; i < argument_count; ++i) model_.command_line += " " + shellWord(arguments[i]);
  std::string help = "musclesim --help";
  try {
    std::vector<std::string> words = ordered({arguments + std::min(argument_count, 1), arguments + argument_count});
    const bool has_command = !words.empty() && std::ranges::count(commandNames(), words.front()) > 0;
    if (has_command) help = fmt::format("musclesim {} --help", words.front());
    model_.arguments.assign(words.begin() + (has_command ? 1 : 0), words.end());
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app_.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_.exit(error);  // --help, --version
    tell(fmt::format("error: {}\n{} lists the options", messageFor(error), help));
    return bad_usage;
  }
  return std::nullopt;
}

int CommandLine::run() {
  for (const auto& [command, action] : commands_)
    if (command->parsed()) return action();
  return run_();
}

}  // namespace musclesim::command_line
