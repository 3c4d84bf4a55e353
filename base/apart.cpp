#include "apart.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

/// First byte of the answer.
constexpr char good = '+', refused = '-', out_of_memory = 'm';

/// Size of this process's address space.
std::size_t addressBytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void limit(const ApartLimits& limits) {
  const auto set = [](__rlimit_resource resource, rlim_t value) {
    const rlimit both{value, value};
    setrlimit(resource, &both);
  };
  set(RLIMIT_CORE, 0);
  if (!apart_is_limited) return;
  set(RLIMIT_CPU, limits.processor_s);
  set(RLIMIT_AS, addressBytes() + limits.memory_bytes);
}

/// The answer of the copy: a byte that says how it went, and the text or the message.
std::string answerOf(const std::function<std::string()>& work) {
  try {
    return good + work();
  } catch (const std::bad_alloc&) {
    return {out_of_memory};
  } catch (const std::exception& error) {
    return refused + std::string(error.what());
  }
}

[[noreturn]] void workInTheCopy(int pipe_end, const ApartLimits& limits, const std::function<std::string()>& work) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);  // complaints of a library that is about to crash
  limit(limits);
  const std::string answer = answerOf(work);
  _exit(writeAll(pipe_end, answer) == answer.size() ? 0 : 1);
}

std::string readAll(int pipe_end) {
  std::string text, block(std::size_t{1} << 16, '\0');
  while (true) {
    const ssize_t count = read(pipe_end, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(block, 0, static_cast<std::size_t>(count));
  }
}

int waitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string doApart(const std::string& file, const ApartLimits& limits, const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw IoError(fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
  const pid_t child = fork();
  if (child == 0) workInTheCopy(ends[1], limits, work);
  const int reason = errno;
  close(ends[1]);
  std::string answer = child < 0 ? "" : readAll(ends[0]);
  close(ends[0]);
  if (child < 0) throw IoError(fmt::format("{}: cannot be read: {}", file, std::strerror(reason)));
  const int status = waitFor(child);
  const bool is_whole = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer.empty();
  if (is_whole && answer[0] == good) return answer.substr(1);
  if (is_whole && answer[0] == refused) {
    const std::string prefix = file + ": ", message = answer.substr(1);
    throw BadFile(file, message.starts_with(prefix) ? message.substr(prefix.size()) : message);
  }
  if (is_whole)
    throw BadFile(file, fmt::format("needs more than {} MB of memory, which a file of its size should not", limits.memory_bytes >> 20));
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    throw BadFile(file, fmt::format("takes longer than {} s to read, which a file of its size should not", limits.processor_s));
  throw BadFile(file, "is damaged: the library that reads such files crashes on it");
}

}  // namespace musclesim
