/// A robot of one's own: a lever on a hinge, pulled down to either side by two muscles in turn. Its motion is recorded in lever.csv, as the
/// program musclesim records its runs.
#include <cmath>
#include <cstdio>
#include <exception>

#include "musclesim/log/recorder.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"

using namespace musclesim;

class Lever : public Robot {
 public:
  explicit Lever(World& world) : Robot(world) {
    Box& bar = addBox({.mass_g = 400, .size_mm = {200, 20, 20}});
    reportAngle("lever", bar.hingeToWorld({.axis = Vector::UnitZ(), .limits_deg = Limits{-40, 40}}));
    for (const double x : {80.0, -80.0}) addMuscle({.from = fixedAt({x, -260, 0}), .to = bar.at({x, -10, 0}), .length_mm = {150, 320}});
    setHand(&bar, {100, 0, 0});
  }
};

/// Swings the lever for two seconds; true if it moved to both sides.
bool swing() {
  registerRobot<Lever>("lever", "a lever between two muscles");
  Simulation simulation;
  Robot& robot = simulation.build("lever");
  Recorder recorder("lever.csv", describeModel(simulation, "built"), robot.signalNames());
  double lowest_deg = 0, highest_deg = 0;
  while (simulation.time_s() < 2) {
    const bool right = std::fmod(simulation.time_s(), 1) < 0.5;
    robot.step(right ? Action{0.6, 0.1} : Action{0.1, 0.6});
    const State state = robot.getState();
    recorder.append(state.time_s, robot.signalValues(state));  // a row: before the world moves
    for (int i = 0; i < 10; ++i) simulation.step();
    lowest_deg = std::fmin(lowest_deg, state.angle_deg[0]);
    highest_deg = std::fmax(highest_deg, state.angle_deg[0]);
    std::printf("%.1f s  %6.2f deg\n", state.time_s, state.angle_deg[0]);
  }
  recorder.close(true);
  return lowest_deg < -5 && highest_deg > 5;
}

int main() {
  try {
    return swing() ? 0 : 1;
  } catch (const std::exception& error) {  // a geometry that cannot be, a file that cannot be written
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
