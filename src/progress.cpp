#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace musclesim::command_line {

namespace {

using Clock = std::chrono::steady_clock;

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : active_(!quiet), is_terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

ProgressLine::~ProgressLine() {
  if (shown_ && is_terminal_) std::fputs("\n", stderr);
}

double ProgressLine::wallS() const {
  return std::max(std::chrono::duration<double>(Clock::now() - start_).count(), 1e-9);
}

bool ProgressLine::isDue(bool at_end) const {
  constexpr std::chrono::milliseconds on_a_terminal(200), in_a_file = std::chrono::seconds(30);
  const bool is_end_told = at_end && (is_terminal_ || shown_);
  return active_ && (is_end_told || Clock::now() - last_ >= (is_terminal_ ? on_a_terminal : in_a_file));
}

void ProgressLine::show(const std::string& text) {
  last_ = Clock::now();
  std::fprintf(stderr, is_terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::show(double simulated_s, const std::string& detail) {
  if (!line_.isDue(simulated_s >= duration_s_)) return;
  const double wall_s = line_.wallS();
  const double left_s = simulated_s > 0 ? wall_s / simulated_s * (duration_s_ - simulated_s) : 0;
  line_.show(fmt::format("{:.1f} of {:g} s simulated, {:.3g} x real time, {} left{}{}", simulated_s, duration_s_, simulated_s / wall_s,
                         duration(left_s), detail.empty() ? "" : "; ", detail));
}

void PhaseProgress::show(const std::string& phase, long done, long expected) {
  if (!line_.isDue(false)) return;
  if (done >= expected) return line_.show(fmt::format("{}: {} simulations so far, {}", phase, done, duration(line_.wallS())));
  const double left_s = done > 0 ? line_.wallS() / static_cast<double>(done) * static_cast<double>(expected - done) : 0;
  line_.show(fmt::format("{}: {} of about {} simulations, about {} left in this phase", phase, done, expected, duration(left_s)));
}

void CaseProgress::show(int done, int count) {
  if (!line_.isDue(done == count)) return;
  line_.show(fmt::format("{} of {} cases, about {} left", done, count, duration(line_.wallS() / done * (count - done))));
}

}  // namespace musclesim::command_line
