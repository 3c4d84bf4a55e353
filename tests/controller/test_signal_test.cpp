#include "musclesim/controller/test_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::atTime;
using test::Prepared;

/// Command of muscle 0 at a time, with level 0.5 and amplitude 0.2 from 0 s on, where muscle 0 alone is moved.
double commanded(const std::string& signal, double time_s, std::vector<std::string> more = {}) {
  Prepared prepared;
  for (const char* assignment : {".level=0.5", ".amplitude=0.2", ".start_s=0"})
    prepared.parameters.setFromText(signal + assignment, "test");
  for (const std::string& assignment : more) prepared.parameters.setFromText(signal + "." + assignment, "test");
  prepared.request.channels = "0";
  const auto controller = makeController(signal, prepared.request);
  prepared.parameters.requireAllKnown();
  const Action action = controller->output(atTime(time_s));
  EXPECT_EQ(action.size(), 2u);
  EXPECT_EQ(action.at(1), 0.5) << "a muscle without channel keeps its level";
  return action.at(0);
}

TEST(TestSignals, RefuseWhatCommandsCannotShow) {
  const auto refusal = [](const std::string& signal, const std::string& assignment) {
    return messageOf<BadParameter>([&] { commanded(signal, 0, {assignment}); });
  };
  EXPECT_TRUE(contains(refusal("multisine", "high_Hz=80"), "be at most 50 Hz"));
  EXPECT_TRUE(contains(refusal("chirp", "to_Hz=400"), "chirp.to_Hz"));
  EXPECT_TRUE(contains(refusal("sine", "period_s=0.01"), "be at least 0.02 s"));
  EXPECT_TRUE(contains(refusal("prbs", "hold_s=0.003"), "be at least 0.01 s"));
  EXPECT_NO_THROW(commanded("prbs", 0, {"hold_s=0.01"}));
}

TEST(TestSignals, FollowTheirFormulas) {
  EXPECT_DOUBLE_EQ(commanded("steps", 1.9, {"period_s=4"}), 0.7);
  EXPECT_DOUBLE_EQ(commanded("steps", 2, {"period_s=4"}), 0.3);
  EXPECT_DOUBLE_EQ(commanded("ramp", 1, {"rise_s=4"}), 0.5 + 0.2 / 4);
  EXPECT_DOUBLE_EQ(commanded("ramp", 9, {"rise_s=4"}), 0.7);
  EXPECT_DOUBLE_EQ(commanded("triangle", 0.5, {"period_s=4"}), 0.6);
  EXPECT_DOUBLE_EQ(commanded("triangle", 3, {"period_s=4"}), 0.3);
  EXPECT_DOUBLE_EQ(commanded("sine", 0.3, {"period_s=2"}), 0.5 + 0.2 * std::sin(std::numbers::pi * 0.3));
  // c = f0 T (k^(t/T) - 1) / ln k with f0 = 1 Hz, T = 10 s, k = 2, t = 5 s
  EXPECT_NEAR(commanded("chirp", 5, {"from_Hz=1", "to_Hz=2", "sweep_s=10"}),
              0.5 + 0.2 * std::sin(2 * std::numbers::pi * 10 * (std::sqrt(2.0) - 1) / std::numbers::ln2), 1e-12);
  EXPECT_NEAR(commanded("chirp", 5, {"from_Hz=1", "to_Hz=2", "sweep_s=10", "sweep=linear"}),
              0.5 + 0.2 * std::sin(2 * std::numbers::pi * (5 + 25.0 / 20)), 1e-12);
  EXPECT_NEAR(std::abs(commanded("prbs", 0.7) - 0.5), 0.2, 1e-15);
  // One frequency: a cosine, whose largest value is 1.
  EXPECT_NEAR(commanded("multisine", 0.3, {"low_Hz=0.5", "high_Hz=0.5", "period_s=10"}),
              0.5 + 0.2 * std::cos(2 * std::numbers::pi * 0.5 * 0.3), 1e-12);
  EXPECT_DOUBLE_EQ(commanded("staircase", 0.5, {"hold_s=1", "step_count=4"}), 0.3);
  EXPECT_DOUBLE_EQ(commanded("staircase", 3, {"hold_s=1", "step_count=4"}), 0.6);
  EXPECT_NEAR(commanded("reversals", 6 + 1.125, {"period_s=6", "loop_count=4"}), 0.5 + 0.2 * 0.75, 1e-12);
}

TEST(TestSignals, HoldTheLevelBeforeTheyBegin) {
  for (const TestSignalInfo& signal : testSignals()) EXPECT_EQ(commanded(signal.name, 0.99, {"start_s=1"}), 0.5) << signal.name;
  EXPECT_DOUBLE_EQ(commanded("steps", 1, {"start_s=1"}), 0.7);
}

TEST(TestSignals, StayWithinTheirAmplitudeAndDependOnTheTimeAlone) {
  for (const TestSignalInfo& signal : testSignals()) {
    Prepared prepared({signal.name + ".level=0.5", signal.name + ".amplitude=0.5"});
    const auto controller = makeController(signal.name, prepared.request);
    double largest = 0;
    std::vector<double> forwards;
    for (int i = 0; i < 3000; ++i) {
      const Action action = controller->output(atTime(0.01 * i));
      ASSERT_TRUE(test::allInUnitRange(action)) << signal.name << " at " << i;
      forwards.push_back(action[0]);
      largest = std::max(largest, std::abs(action[0] - 0.5));
    }
    EXPECT_GT(largest, 0.49) << signal.name;
    for (int i = 2999; i >= 0; i -= 7) ASSERT_EQ(controller->output(atTime(0.01 * i))[0], forwards[static_cast<std::size_t>(i)]);
  }
}

TEST(TestSignals, AntagonistsMoveByDifferenceOrCoContraction) {
  Prepared prepared({"ramp.start_s=0", "ramp.rise_s=1", "ramp.amplitude=0.1", "ramp.level_1=0.3"});
  prepared.request.channels = "0:1";
  EXPECT_EQ(makeController("ramp", prepared.request)->output(atTime(2)), Action({0.4 + 0.1, 0.3 - 0.1}));
  Prepared together({"ramp.drive=co_contraction"});
  together.request.channels = "0:1";
  EXPECT_EQ(makeController("ramp", together.request)->output(atTime(20)), Action({0.5, 0.5}));
}

TEST(TestSignals, ChannelsHaveAmplitudesShiftsAndRandomStreams) {
  Prepared prepared({"steps.start_s=0", "steps.period_s=2", "steps.amplitude_1=-0.2", "steps.shift_s=1"});
  prepared.request.channels = "0,1";
  const auto controller = makeController("steps", prepared.request);
  EXPECT_EQ(controller->output(atTime(0.5)), Action({0.5, 0.4}));
  EXPECT_EQ(controller->output(atTime(1.5)), Action({0.4 - 0.1, 0.4 - 0.2}));
  const auto sequence = [](std::uint64_t seed, std::size_t muscle) {
    Prepared prbs({"prbs.start_s=0"});
    prbs.request.channels = "0,1";
    prbs.request.seed = seed;
    const auto controller = makeController("prbs", prbs.request);
    std::vector<double> values;
    for (int i = 0; i < 127; ++i) values.push_back(controller->output(atTime(0.2 * i))[muscle]);
    return values;
  };
  EXPECT_EQ(sequence(1, 0), sequence(1, 0));
  EXPECT_NE(sequence(1, 0), sequence(2, 0));
  EXPECT_NE(sequence(1, 0), sequence(1, 1));
}

TEST(TestSignals, RefuseCommandsBeyondFullScale) {
  Prepared prepared({"sine.level=0.4", "sine.amplitude=0.45"});
  const std::string message = messageOf<BadParameter>([&] { makeController("sine", prepared.request); });
  EXPECT_TRUE(contains(message, "sine.amplitude = 0.45")) << message;
  EXPECT_TRUE(contains(message, "at most 0.4")) << message;
}

TEST(TestSignals, FindTheAntagonistsOfTheRobot) {
  Simulation simulation;
  Robot& elbow = simulation.build("elbow");
  Prepared prepared;
  prepared.request.robot = &elbow;
  const TestSignalController controller("sine", prepared.request);
  ASSERT_EQ(controller.channels().size(), 1u);
  EXPECT_EQ(controller.channels().front().text(), "elbow=0:1");
}

}  // namespace
}  // namespace musclesim
