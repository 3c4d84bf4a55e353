/// Runs the program `musclesim` as a user would and returns what it said.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace musclesim {

struct ProgramResult {
  int status;  ///< exit status; 128 + signal if it was killed
  std::string out, err;
};

/// Starts the program with the arguments in a folder and waits for it.
ProgramResult runProgram(const std::vector<std::string>& arguments,
                         const std::filesystem::path& folder = std::filesystem::temp_directory_path());

/// Starts it, sends a signal after a delay, and waits.
ProgramResult interruptProgram(const std::vector<std::string>& arguments, int signal, int delay_ms,
                               const std::filesystem::path& folder = std::filesystem::temp_directory_path());

}  // namespace musclesim
