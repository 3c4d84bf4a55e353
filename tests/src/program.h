/// Runs the program `musclesim` as a user would and returns its output.
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

/// Starts the program in its own process group and waits until a file in the folder has this number of bytes (a minute at most). Then it
/// sends a signal to the group, as a terminal does, and waits for the end.
ProgramResult interruptProgram(const std::vector<std::string>& arguments, int signal, const std::string& file, std::uintmax_t bytes,
                               const std::filesystem::path& folder = std::filesystem::temp_directory_path());

}  // namespace musclesim
