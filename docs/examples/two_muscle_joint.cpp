/// A robot of one's own: a lever on a hinge, pulled down to either side by two muscles in turn.
#include <cmath>
#include <cstdio>

#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot_registry.h"
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

int main() {
  registerRobot<Lever>("lever", "a lever between two muscles");
  Simulation simulation;
  Robot& robot = simulation.build("lever");
  double lowest_deg = 0, highest_deg = 0;
  while (simulation.time_s() < 2) {
    const bool right = std::fmod(simulation.time_s(), 1) < 0.5;
    robot.step(right ? Action{0.6, 0.1} : Action{0.1, 0.6});
    for (int i = 0; i < 10; ++i) simulation.step();
    const double angle_deg = robot.getState().angle_deg[0];
    lowest_deg = std::fmin(lowest_deg, angle_deg);
    highest_deg = std::fmax(highest_deg, angle_deg);
    std::printf("%.1f s  %6.2f deg\n", simulation.time_s(), angle_deg);
  }
  return lowest_deg < -5 && highest_deg > 5 ? 0 : 1;  // it moved to both sides
}
