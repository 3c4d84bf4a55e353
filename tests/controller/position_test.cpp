#include "musclesim/controller/position.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A run of the elbow with chain muscles in si under the position controller.
struct Tracking {
  std::vector<double> error_deg;  ///< per control step of 0.01 s
  std::vector<Action> commands;

  double largest(double from_s) const {
    double largest = 0;
    for (std::size_t i = static_cast<std::size_t>(std::lround(from_s / 0.01)); i < error_deg.size(); ++i)
      largest = std::max(largest, std::abs(error_deg[i]));
    return largest;
  }
};

Tracking track(const std::vector<std::string>& parameters, double duration_s, const std::vector<ActiveEffect>& effects = {},
               const std::string& targets_file = "") {
  SimulationOptions options;
  for (const std::string& assignment : parameters) options.parameters.setFromText(assignment, "test");
  options.effects = effects;
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build("elbow");
  ControllerRequest request{simulation.parameters()};
  request.muscle_count = robot.actuatorCount();
  request.robot = &robot;
  request.targets_file = targets_file;
  Controller& controller = simulation.control(makeController("position", request));
  simulation.parameters().requireAllKnown();
  Action action = controller.output(robot.getState());
  simulation.start(robot.initialState(), action);
  Tracking tracking;
  while (simulation.time_s() < duration_s) {
    const State state = robot.getState();
    if (simulation.stepCount() > 0) action = controller.output(state);
    tracking.error_deg.push_back(controller.signals().front().second - state.angle_deg.front());
    tracking.commands.push_back(action);
    robot.step(action);
    simulation.step();
  }
  return tracking;
}

const std::vector<std::string> sine = {"position.amplitude_elbow_deg=20", "position.period_s=2"};

TEST(PositionController, HoldsTheElbowOnASine) {
  EXPECT_LT(track(sine, 8).largest(2), 0.5);
}

TEST(PositionController, LosesItWithADeadTime) {
  const ActiveEffect dead_time = {"transport_delay", "all", {{"delay_s", 0.1}}};
  // The loop's own swing: the forearm is thrown from stop to stop (-70 .. 70 degrees), faster than the target moves.
  const Tracking late = track(sine, 8, {dead_time});
  EXPECT_GT(late.largest(4), 50);
  int turns = 0;  // of the command, from one end to the other
  for (std::size_t i = 500; i < 800; ++i) turns += (late.commands[i][0] > 0.4) != (late.commands[i - 1][0] > 0.4);
  EXPECT_GT(turns, 8) << "the target turns three times in 3 s";
}

TEST(PositionController, ADelayedSensorShowsInTheLoop) {
  const ActiveEffect late = {"sensor_delay", "signal_angle_elbow", {{"delay_s", 0.1}, {"filter_share", 0.0}}};
  EXPECT_GT(track(sine, 6, {late}).largest(2), 2);
}

TEST(PositionController, BringsAPayloadToTheTargetByIntegration) {
  const ActiveEffect payload = {"payload", "all", {{"mass_kg", 0.3}}};
  const Tracking tracking = track({"position.target_elbow_deg=15"}, 6, {payload});
  EXPECT_GT(std::abs(tracking.error_deg.at(1)), 1) << "the clean model does not know the payload";
  EXPECT_LT(tracking.largest(5), 0.1);
}

TEST(PositionController, DoesNotWindUp) {
  std::ofstream(testing::TempDir() + "beyond.csv") << "time_s,angle_elbow_deg\n0,0\n0.5,100\n4,100\n4.01,10\n9,10\n";
  const Tracking tracking = track({}, 7, {}, testing::TempDir() + "beyond.csv");
  EXPECT_GT(tracking.error_deg.at(350), 25) << "a target beyond the joint's stop at 70 degrees";
  EXPECT_LT(tracking.largest(5.5), 1) << "back within a second and a half";
}

TEST(PositionController, RefusesTargetsBeyondTheStops) {
  const auto refusal = [](const std::vector<std::string>& parameters) { return messageOf<BadParameter>([&] { track(parameters, 0.1); }); };
  EXPECT_TRUE(contains(refusal({"position.amplitude_elbow_deg=80"}), "position.amplitude_elbow_deg = 80 deg: must be at most 70 deg"));
  EXPECT_TRUE(contains(refusal({"position.amplitude_elbow_deg=-31", "position.target_elbow_deg=40"}),
                       "at most 30 deg about the middle of 40 deg: the stops of the joint are at -70 and 70 deg"));
  EXPECT_TRUE(contains(refusal({"position.target_elbow_deg=71"}), "position.target_elbow_deg = 71 deg: must lie in -70 .. 70 deg"));
  EXPECT_EQ(track({"position.amplitude_elbow_deg=70"}, 0.02).commands.size(), 2U) << "the stops themselves are allowed";
}

TEST(PositionController, SaysThatTargetsOfAFileAreBeyondTheStops) {
  const std::string file = testing::TempDir() + "far.csv";
  const auto notes = [&](const std::string& targets) {
    std::ofstream(file) << "time_s,angle_elbow_deg\n0,0\n1," << targets << "\n";
    Simulation simulation;
    Robot& robot = simulation.build("elbow");
    ControllerRequest request{simulation.parameters()};
    request.muscle_count = robot.actuatorCount();
    request.robot = &robot;
    request.targets_file = file;
    std::string all;
    for (const std::string& note : makeController("position", request)->notes()) all += note + "\n";
    return all;
  };
  EXPECT_TRUE(contains(notes("-85"), "the targets of joint elbow run from -85 to 0 degrees, but its stops allow -70 .. 70"));
  EXPECT_FALSE(contains(notes("69"), "stops"));
}

TEST(PositionController, IsRefusedWithoutAntagonists) {
  Simulation simulation;
  Robot& rig = simulation.build("rig");
  ControllerRequest request{simulation.parameters()};
  request.muscle_count = 1;
  request.robot = &rig;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("position", request); }), "--channels"));
  request.robot = nullptr;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("position", request); }), "robot"));
}

TEST(PositionController, TargetFilesMustHaveTheTarget) {
  const std::string file = testing::TempDir() + "wrong.csv";
  std::ofstream(file) << "time_s,angle_wrist_deg\n0,1\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { track({}, 0.1, {}, file); }), "target_elbow_deg"));
  std::ofstream(file) << "time_s,angle_elbow_deg\n0,1\n1,\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { track({}, 0.1, {}, file); }), "wrong.csv:3"));
}

}  // namespace
}  // namespace musclesim
