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

/// Starts it in a process group of its own, sends a signal to the group, as a terminal does, when a file in the folder has that many bytes
/// (after a minute at the latest), and waits.
ProgramResult interruptProgram(const std::vector<std::string>& arguments, int signal, const std::string& file, std::uintmax_t bytes,
                               const std::filesystem::path& folder = std::filesystem::temp_directory_path());

}  // namespace musclesim
