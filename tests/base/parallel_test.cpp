#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace musclesim {
namespace {

TEST(ParallelFor, DoesEachPieceOnce) {
  for (const int jobs : {0, 1, 3, 100}) {
    std::vector<std::atomic<int>> calls(37);
    parallelFor(37, jobs, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelFor, DoesNothingForNothing) {
  parallelFor(0, 2, [](int) { FAIL(); });
}

TEST(ParallelFor, ThrowsTheFirstFailureByIndexAfterAllHaveEnded) {
  std::atomic<int> calls = 0;
  try {
    parallelFor(20, 2, [&](int i) {
      ++calls;
      if (i == 7 || i == 13) throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "7");
  }
  EXPECT_EQ(calls, 20);
}

TEST(ParallelFor, CallsWithinShareTheThreads) {
  std::vector<std::atomic<int>> calls(6 * 5);
  std::atomic<int> at_once = 0, most = 0;
  parallelFor(6, 3, [&](int i) {
    parallelFor(5, 3, [&](int k) {
      const int now = ++at_once;
      for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      ++calls[static_cast<std::size_t>(5 * i + k)];
      --at_once;
    });
  });
  for (const auto& count : calls) EXPECT_EQ(count, 1);
  EXPECT_LE(most, 3) << "no more threads than the outer call has";
}

/// Each piece waits for the other one, which only another thread can start.
TEST(ParallelFor, IdleThreadsHelpWithin) {
  std::atomic<int> begun = 0;
  parallelFor(1, 2, [&](int) {
    parallelFor(2, 2, [&](int) {
      ++begun;
      const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (begun < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      EXPECT_EQ(begun, 2);
    });
  });
}

/// The thread whose own piece ends at once helps with the pieces within the other one, each of which waits for the other.
TEST(ParallelFor, ThreadsThatWaitHelpWithin) {
  std::atomic<int> begun = 0;
  parallelFor(2, 2, [&](int i) {
    if (i == 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    parallelFor(2, 2, [&](int) {
      ++begun;
      const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (begun < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      EXPECT_EQ(begun, 2);
    });
  });
}

TEST(ParallelFor, OneJobKeepsToItsThread) {
  parallelFor(2, 2, [&](int) {
    const std::thread::id own = std::this_thread::get_id();
    parallelFor(20, 1, [&](int) { EXPECT_EQ(std::this_thread::get_id(), own); });
  });
}

TEST(ParallelFor, FailuresWithinAreThrownOutside) {
  EXPECT_THROW(parallelFor(3, 2,
                           [](int i) {
                             parallelFor(3, 2, [i](int k) {
                               if (i == 1 && k == 2) throw std::runtime_error("within");
                             });
                           }),
               std::runtime_error);
}

}  // namespace
}  // namespace musclesim
