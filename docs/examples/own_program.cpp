// The whole program with a robot of one's own: run, window, replay, diagnose and all other commands know it by its name.
//
//     cmake -S docs/examples -B build-examples -DCMAKE_PREFIX_PATH=<prefix> && cmake --build build-examples
//     build-examples/own_program --robot pendulum --simple --duration 5
#include "musclesim/program.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot_registry.h"

using namespace musclesim;

class Pendulum : public Robot {
 public:
  explicit Pendulum(World& world) : Robot(world) {
    Box& bar = addBox({.mass_g = 400, .center_mm = {0, -100, 0}, .size_mm = {20, 200, 20}, .name = "bar"});
    reportAngle("pendulum", bar.hingeToWorld({.anchor_mm = Vector(0, 0, 0), .limits_deg = Limits{-60, 60}}));
    for (const double side : {1.0, -1.0})
      addMuscle({.from = fixedAt({40 * side, 250, 0}), .to = bar.at({40 * side, -10, 0}), .length_mm = {150, 320}});
    setHand(&bar);
  }
};

int main(int argument_count, char** arguments) {
  registerRobot<Pendulum>("pendulum", "a pendulum between two muscles");
  return program(argument_count, arguments);
}
