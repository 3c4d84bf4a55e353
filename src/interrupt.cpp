#include "interrupt.h"

#include <csignal>

namespace musclesim::command_line {

namespace {

volatile std::sig_atomic_t received = 0;

void note(int signal) {
  received = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watchInterrupts() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

void endAtInterrupts() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

int interruptSignal() {
  return received;
}

}  // namespace musclesim::command_line
