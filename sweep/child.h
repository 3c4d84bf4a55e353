/// One run of a program in a process of its own, so that whatever happens to it happens to nobody else.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace musclesim {

struct ChildCommand {
  std::string program;
  std::vector<std::string> arguments;
  std::string folder;                ///< where it runs
  std::string out_file, error_file;  ///< its standard output and error; created anew
};

struct ChildEnd {
  int exit_status = 0;   ///< if no signal ended it
  int signal = 0;        ///< the signal that ended it, 0: none
  bool stopped = false;  ///< `stop` asked for its end
  double wall_s = 0;
};

/// Starts the command, without a shell, and waits for its end. `stop` is asked several times a second; when it says true, the child gets
/// SIGTERM and, five seconds later, SIGKILL. If this process dies, the child dies with it. Sets SIGCHLD to its default. Throws IoError if
/// it cannot be started or its end cannot be learnt.
ChildEnd runChild(const ChildCommand& command, const std::function<bool()>& stop);

/// The program that this process runs, also if its file has been replaced since.
constexpr const char* own_program = "/proc/self/exe";

}  // namespace musclesim
