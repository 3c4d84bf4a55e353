#include "musclesim/simulation/ensemble.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "musclesim/base/random.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Position of an arm's hand after 0.1 s of random pressures.
Vector handAfter(std::uint64_t seed) {
  Simulation simulation;
  simulation.build("arm");
  RandomStream random(seed, "test");
  for (int i = 0; i < 10; ++i) {
    Action command(10);
    for (double& pressure : command) pressure = random.uniform();
    simulation.robot().step(command);
    simulation.step();
  }
  return *simulation.robot().getState().hand_mm;
}

TEST(Ensemble, HasTheBitsOfSimulationsOneAfterTheOther) {
  constexpr int count = 8;
  std::vector<Vector> alone(count), together(count);
  for (int i = 0; i < count; ++i) alone[static_cast<std::size_t>(i)] = handAfter(static_cast<std::uint64_t>(i));
  runEnsemble(count, 4, [&](int i) { together[static_cast<std::size_t>(i)] = handAfter(static_cast<std::uint64_t>(i)); });
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(alone[i], together[i]) << i;
  EXPECT_NE(alone[0], alone[1]) << "seeds differ";
}

TEST(Ensemble, DoesEachOnceAndThrowsTheFirstFaultAtTheEnd) {
  std::atomic<int> calls{0};
  const std::string message = messageOf<BadParameter>([&] {
    runEnsemble(20, 3, [&](int i) {
      ++calls;
      if (i == 7 || i == 12) throw BadParameter("number " + std::to_string(i));
    });
  });
  EXPECT_TRUE(contains(message, "number 7"));
  EXPECT_EQ(calls, 20);
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { runEnsemble(1, -1, [](int) {}); }), "threads"));
}

}  // namespace
}  // namespace musclesim
