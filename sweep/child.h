/// Runs a program in a process of its own, so that a crash affects only that process.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace musclesim {

struct ChildCommand {
  std::string program;
  std::vector<std::string> arguments;
  std::string folder;                ///< working folder
  std::string out_file, error_file;  ///< files for its standard output and error; replaced if they exist
};

struct ChildEnd {
  int exit_status = 0;   ///< valid if no signal ended it
  int signal = 0;        ///< the signal that ended it, 0: none
  bool stopped = false;  ///< it was ended because `stop` returned true
  double wall_s = 0;
};

/// Starts the command, without a shell, and waits for its end. `stop` is called several times a second; when it returns true, the
/// child gets SIGTERM and, five seconds later, SIGKILL. If this process dies, so does the child. Sets SIGCHLD to its default. Throws
/// IoError if the child cannot be started or waited for.
ChildEnd runChild(const ChildCommand& command, const std::function<bool()>& stop);

/// The path of the program that this process runs; valid also if its file has been replaced since.
constexpr const char* own_program = "/proc/self/exe";

}  // namespace musclesim
