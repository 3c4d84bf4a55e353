/// The command line of the program: its commands and their options.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"

namespace musclesim::command_line {

class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Reads the arguments, beginning with the program's name. Returns an exit status if no command is to run (--help, a usage error).
  std::optional<int> parse(int argument_count, const char* const* arguments);
  /// Runs the parsed command and returns the exit status. Errors are thrown.
  int run();

 private:
  std::vector<std::string> commandNames() const;
  std::vector<std::string> ordered(std::vector<std::string> arguments) const;
  std::string messageFor(const CLI::ParseError& error) const;

  CLI::App app_;
  ModelOptions model_;
  Action run_;
  std::vector<std::pair<CLI::App*, Action>> commands_;
};

}  // namespace musclesim::command_line
