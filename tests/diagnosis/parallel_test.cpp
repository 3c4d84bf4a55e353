#include "diagnosis/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
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

}  // namespace
}  // namespace musclesim
