#include "simulation/display/pace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace musclesim {
namespace {

using namespace std::chrono_literals;

bool never() {
  return false;
}

/// Runs steps of 10 ms in a separate thread until the pace stops it.
class Runner {
 public:
  explicit Runner(Pace& pace)
      : thread_([this, &pace] {
          while (pace.waitFor(0.01 * static_cast<double>(count_), never)) ++count_;
        }) {}
  long count() const { return count_; }

 private:
  std::atomic<long> count_ = 0;
  std::jthread thread_;
};

TEST(Pace, KeepsTheSpeed) {
  for (const double speed : {1.0, 4.0}) {
    Pace pace(speed);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i <= 40; ++i) ASSERT_TRUE(pace.waitFor(0.01 * i, never));
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_GE(wall_s, 0.399 / speed);
    EXPECT_LT(wall_s, 0.4 / speed + 0.3);
  }
}

TEST(Pace, PauseStopsAndSingleStepsGoOneByOne) {
  Pace pace(1000);
  pace.setPaused(true);
  Runner runner(pace);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(runner.count(), 0);
  for (int steps = 1; steps <= 3; ++steps) {
    pace.stepOnce();
    std::this_thread::sleep_for(100ms);
    EXPECT_EQ(runner.count(), steps);
    EXPECT_TRUE(pace.isPaused());
  }
  EXPECT_EQ(pace.measuredSpeed(), 0);
  pace.setPaused(false);
  std::this_thread::sleep_for(100ms);
  EXPECT_GT(runner.count(), 100);
  pace.close();
}

TEST(Pace, LostTimeIsNotCaughtUp) {
  Pace pace(1);
  ASSERT_TRUE(pace.waitFor(0, never));
  std::this_thread::sleep_for(400ms);  // a step that took long
  ASSERT_TRUE(pace.waitFor(0.01, never));
  const auto start = std::chrono::steady_clock::now();
  for (int i = 2; i <= 21; ++i) ASSERT_TRUE(pace.waitFor(0.01 * i, never));
  EXPECT_GE(std::chrono::steady_clock::now() - start, 190ms);
}

TEST(Pace, ClosingAndInterruptsEndEveryWait) {
  Pace pace(1);
  Runner runner(pace);
  std::this_thread::sleep_for(20ms);
  pace.close();
  EXPECT_FALSE(pace.waitFor(1e6, never));
  EXPECT_TRUE(pace.isClosed());
  Pace paused(1);
  paused.setPaused(true);
  EXPECT_FALSE(paused.waitFor(0, [] { return true; }));
}

TEST(Pace, SpeedStaysInRange) {
  Pace pace(1);
  pace.setSpeed(1e9);
  EXPECT_EQ(pace.speed(), 1e4);
  pace.setSpeed(0);
  EXPECT_EQ(pace.speed(), 1e-3);
}

}  // namespace
}  // namespace musclesim
