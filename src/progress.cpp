#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace musclesim::program {

namespace {

using Clock = std::chrono::steady_clock;

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

}  // namespace

Progress::Progress(double duration_s, bool quiet)
    : duration_s_(duration_s), active_(!quiet && isatty(STDERR_FILENO)), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\n", stderr);
}

double Progress::wallS() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::show(double simulated_s, const std::string& detail) {
  constexpr auto interval = std::chrono::milliseconds(200);
  if (!active_ || (Clock::now() - last_ < interval && simulated_s < duration_s_)) return;
  last_ = Clock::now();
  const double wall_s = std::max(wallS(), 1e-9);
  const double left_s = simulated_s > 0 ? wall_s / simulated_s * (duration_s_ - simulated_s) : 0;
  std::fprintf(stderr, "\r\033[K%s",
               fmt::format("{:.1f} of {:g} s simulated, {:.3g} x real time, {} left{}{}", simulated_s, duration_s_, simulated_s / wall_s,
                           duration(left_s), detail.empty() ? "" : "; ", detail)
                   .c_str());
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace musclesim::program
