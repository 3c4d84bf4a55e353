#include "musclesim/simulation/run_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/support.h"

namespace musclesim {
namespace {

/// Commands the time, and reports a target.
class Clocked final : public Controller {
 public:
  Action output(const State& state) override { return {state.time_s}; }
  std::optional<double> activity() const override { return 0.5; }
  std::optional<Vector> targetMm() const override { return Vector(1, 2, 3); }
  bool targetIsHeight() const override { return is_height; }
  bool is_height = false;
};

struct Row {
  double time_s, command;
  bool is_due;
};

std::vector<Row> rowsOf(RunLoop loop) {
  Simulation simulation;
  simulation.build("rig");
  Clocked controller;
  std::vector<Row> rows;
  loop.row = [&](const State& state, bool is_due) { rows.push_back({state.time_s, state.command[0], is_due}); };
  simulation.start("settled", {0.0});
  runLoop(simulation, controller, {0.0}, loop);
  return rows;
}

TEST(RunLoop, AsksEveryStepAndRecordsEveryInterval) {
  std::vector<double> late;
  RunLoop loop{0.05, 0.02, nullptr};
  loop.command_is_late = [&](double interval_s) { late.push_back(interval_s); };
  const std::vector<Row> rows = rowsOf(loop);
  ASSERT_EQ(rows.size(), 6U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(rows[i].time_s, 0.01 * static_cast<double>(i));
    EXPECT_EQ(rows[i].command, rows[i].time_s);
    EXPECT_EQ(rows[i].is_due, i % 2 == 0) << i;
  }
  EXPECT_DOUBLE_EQ(rows[5].time_s, 0.05);
  EXPECT_EQ(rows[5].command, rows[5].time_s) << "the last row, too, has the command of its time";
  EXPECT_TRUE(rows[5].is_due);
  EXPECT_EQ(late, (std::vector<double>{0.02, 0.02})) << "commands changed at 0.01 s and 0.03 s, between rows";
}

TEST(RunLoop, EndsWhenAsked) {
  int steps = 0;
  RunLoop loop{1, {}, nullptr};
  loop.after_step = [&] { ++steps; };
  loop.goes_on = [&] { return steps < 3; };
  const std::vector<Row> rows = rowsOf(loop);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_TRUE(rows.back().is_due);
  EXPECT_DOUBLE_EQ(rows.back().time_s, 0.03);
}

TEST(RunLoop, RecordsWhatTheControllerReports) {
  Simulation simulation;
  simulation.build("rig");
  Clocked controller;
  std::vector<std::string> names = runColumns(simulation.robot(), controller);
  EXPECT_EQ(std::vector<std::string>(names.end() - 4, names.end()),
            (std::vector<std::string>{"target_x_mm", "target_y_mm", "target_z_mm", "activity"}));
  EXPECT_EQ(runRow(simulation.robot(), controller, simulation.robot().getState()).size(), names.size());
  controller.is_height = true;
  names = runColumns(simulation.robot(), controller);
  EXPECT_EQ(std::vector<std::string>(names.end() - 2, names.end()), (std::vector<std::string>{"target_y_mm", "activity"}));
  const std::vector<double> row = runRow(simulation.robot(), controller, simulation.robot().getState());
  EXPECT_EQ(std::vector<double>(row.end() - 2, row.end()), (std::vector<double>{2, 0.5}));
}

TEST(RunLoop, RefusesTimesThatCannotBe) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double duration_s : {0.0, 0.001, -1.0, 2e7, nan})
    EXPECT_THROW((RunLoop{duration_s, {}, nullptr}.requireTimes(0.01)), BadParameter) << duration_s;
  for (const double interval_s : {0.0, -1.0, nan})
    EXPECT_THROW((RunLoop{1, interval_s, nullptr}.requireTimes(0.01)), BadParameter) << interval_s;
  EXPECT_NO_THROW((RunLoop{0.01, 0.5, nullptr}.requireTimes(0.01)));
}

TEST(RunLoop, DecisionsComeAsOftenAsThePhysicsNeeds) {
  for (const auto& [kind, expected_s] :
       {std::pair{PhysicsKind::si, 3.0}, {PhysicsKind::original, 6.0}, {PhysicsKind::scaled, 6 / std::sqrt(1000.0)}}) {
    Parameters parameters;
    EXPECT_DOUBLE_EQ(defaultDecisionIntervalS(PhysicsSettings(kind, parameters)), expected_s);
  }
}

}  // namespace
}  // namespace musclesim
