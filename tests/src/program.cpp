#include "src/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace musclesim {

namespace {

std::string outputIn(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void redirect(const std::filesystem::path& file, int descriptor) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(opened, descriptor);
  close(opened);
}

}  // namespace

namespace {

/// Waits until a file has this number of bytes, for a minute at most.
void waitForBytes(const std::filesystem::path& file, std::uintmax_t bytes) {
  for (int i = 0; i < 1200; ++i) {
    std::error_code absent;
    const auto size = std::filesystem::file_size(file, absent);
    if (!absent && size >= bytes) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

ProgramResult interruptProgram(const std::vector<std::string>& arguments, int signal, const std::string& file, std::uintmax_t bytes,
                               const std::filesystem::path& folder) {
  static int call_count = 0;
  const auto stem =
      std::filesystem::temp_directory_path() / ("musclesim_program_" + std::to_string(getpid()) + "_" + std::to_string(++call_count));
  const std::filesystem::path out_file = stem.string() + ".out", err_file = stem.string() + ".err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    if (signal != 0) setpgid(0, 0);
    redirect(out_file, STDOUT_FILENO);
    redirect(err_file, STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(126);
    std::vector<char*> argv = {const_cast<char*>(MUSCLESIM_PROGRAM)};
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    execv(argv[0], argv.data());
    _exit(127);
  }
  if (signal != 0) {
    waitForBytes(folder / file, bytes);
    kill(-child, signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramResult result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), outputIn(out_file), outputIn(err_file)};
  std::filesystem::remove(out_file);
  std::filesystem::remove(err_file);
  return result;
}

ProgramResult runProgram(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return interruptProgram(arguments, 0, "", 0, folder);
}

}  // namespace musclesim
