// A robot in C++ for the program: compile it as a shared library and load it with --plugin.
//
//     c++ -std=c++20 -shared -fPIC -I<prefix>/include -I/usr/include/eigen3 plugin.cpp -o libpendulum.so
//     musclesim --plugin ./libpendulum.so --robot pendulum --simple --duration 5
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

extern "C" void musclesim_plugin() {
  registerRobot<Pendulum>("pendulum", "a pendulum between two muscles");
}
