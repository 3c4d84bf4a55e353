#include "child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr int could_not_start = 127;
constexpr double patience_s = 5;

/// Opens an output file in the parent, so that it exists even if the child is killed at once.
class OpenFile {
 public:
  OpenFile(const std::string& file, int flags) : descriptor_(open(file.c_str(), flags | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) throw IoError(fmt::format("{}: cannot be opened: {}", file, std::strerror(errno)));
  }
  ~OpenFile() { close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  bool become(int descriptor) const { return dup2(descriptor_, descriptor) >= 0; }

 private:
  int descriptor_;
};

struct StandardFiles {
  OpenFile in, out, error;
};

/// Runs in the child before exec. It may only make calls that are safe between fork and exec.
[[noreturn]] void become(const ChildCommand& command, const StandardFiles& files, char* const* arguments, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(could_not_start);
  setpgid(0, 0);  // Ctrl-C reaches only the worker, which then ends the child
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  if (files.in.become(STDIN_FILENO) && files.out.become(STDOUT_FILENO) && files.error.become(STDERR_FILENO) &&
      chdir(command.folder.c_str()) == 0)
    execv(command.program.c_str(), arguments);
  _exit(could_not_start);
}

/// Waits for the end of a process and calls `stop` meanwhile.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid), descriptor_(static_cast<int>(syscall(SYS_pidfd_open, pid, 0))) {}
  ~Child() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  ChildEnd wait(const std::function<bool()>& stop) {
    ChildEnd end;
    int status = 0;
    double stopped_at_s = 0;
    bool killed = false;
    while (!hasEnded(status)) {
      if (!end.stopped && stop()) {
        end.stopped = true;
        stopped_at_s = elapsedS();
        kill(pid_, SIGTERM);
      }
      if (end.stopped && !killed && elapsedS() - stopped_at_s > patience_s) {
        killed = true;
        kill(pid_, SIGKILL);
      }
      pause();
    }
    end.wall_s = elapsedS();
    end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    end.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    return end;
  }

 private:
  bool hasEnded(int& status) const {
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) throw IoError(fmt::format("process {}: its end is not known: {}", pid_, std::strerror(errno)));
    return ended > 0;
  }
  /// Waits until the child ends or a signal arrives, at most 0.2 s; without process descriptors (Linux before 5.3) it waits 5 ms.
  void pause() const {
    pollfd ended{descriptor_, POLLIN, 0};
    poll(&ended, descriptor_ >= 0 ? 1 : 0, descriptor_ >= 0 ? 200 : 5);
  }
  double elapsedS() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  pid_t pid_;
  int descriptor_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

ChildEnd runChild(const ChildCommand& command, const std::function<bool()>& stop) {
  std::vector<char*> arguments = {const_cast<char*>(command.program.c_str())};
  for (const std::string& argument : command.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  constexpr int anew = O_WRONLY | O_CREAT | O_TRUNC;
  const StandardFiles files{{"/dev/null", O_RDONLY}, {command.out_file, anew}, {command.error_file, anew}};
  std::signal(SIGCHLD, SIG_DFL);  // some parent processes leave it ignored; then the system keeps no exit status
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw IoError(fmt::format("{}: no process can be started: {}", command.program, std::strerror(errno)));
  if (pid == 0) become(command, files, arguments.data(), parent);
  const ChildEnd end = Child(pid).wait(stop);
  if (end.signal == 0 && end.exit_status == could_not_start) throw IoError(command.program + ": cannot be started");
  return end;
}

}  // namespace musclesim
