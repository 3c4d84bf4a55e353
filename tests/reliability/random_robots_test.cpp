/// Absurd robots from random calls of the building API: each completes a run of 200 steps, diverges, or is refused.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/random.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A tree of primitives with random joints, and muscles between them. One call may get an impossible number.
class RandomRobot : public Robot {
 public:
  RandomRobot(World& world, std::uint64_t seed, bool spoil) : Robot(world), random_(seed, "random_robot"), spoil_(spoil) {
    const int part_count = whole(1, 5);
    spoilt_call_ = whole(0, 2 * part_count - 1);
    for (int i = 0; i < part_count; ++i) addPart();
    if (random_.uniform() < 0.5) parts_.front()->fix();
    const int muscle_count = whole(1, 3);
    for (int i = 0; i < muscle_count; ++i) addMuscle(whole(0, part_count - 1));
  }

 private:
  int whole(int low, int high) { return low + static_cast<int>(random_.uniform() * (high - low + 1)); }

  /// A plausible number; one number per robot may be impossible.
  double number(double low, double high) {
    static const double impossible[] = {std::nan(""), HUGE_VAL, -1, 0, 1e308};
    if (spoil_ && call_++ == spoilt_call_) return impossible[whole(0, 4)];
    return random_.uniform(low, high);
  }

  Vector direction() {
    Vector v(random_.normal(), random_.normal(), random_.normal());
    return v.normalized();
  }

  void addPart() {
    const Vector place = parts_.empty() ? Vector(0, 0, 0) : Vector(parts_.back()->getPosition() + random_.uniform(60, 200) * direction());
    const double mass_g = number(10, 2000);
    Primitive* part = nullptr;
    switch (whole(0, 2)) {
      case 0:
        part = new Box(world(), space(), place, mass_g, 0, number(5, 80), random_.uniform(5, 80), random_.uniform(5, 80));
        break;
      case 1:
        part = new Sphere(world(), space(), place, mass_g, 0, number(5, 40));
        break;
      default:
        part = new CappedCylinder(world(), space(), place, mass_g, 0, number(5, 30), random_.uniform(10, 100));
        break;
    }
    if (random_.uniform() < 0.3) part->rotate(random_.uniform(-180, 180), direction());
    if (!parts_.empty()) join(part, parts_[static_cast<std::size_t>(whole(0, static_cast<int>(parts_.size()) - 1))]);
    parts_.push_back(part);
  }

  void join(Primitive* part, Primitive* other) {
    const Vector anchor = 0.5 * (part->getPosition() + other->getPosition()), axis = direction();
    switch (whole(0, 4)) {
      case 0:
        part->attachBall(other, anchor);
        break;
      case 1:
        addAngle("joint_" + std::to_string(parts_.size()), part->attachHinge(other, anchor, axis, -60, 60));
        break;
      case 2:
        part->attachHinge(other, anchor, axis);
        break;
      case 3:
        part->attachUniversal(other, anchor, axis, axis.unitOrthogonal());
        break;
      default:
        part->attachSlider(other, axis);
        break;
    }
  }

  void addMuscle(int part) {
    const Vector end = parts_[static_cast<std::size_t>(part)]->getPosition(), start = end + random_.uniform(120, 240) * direction();
    const double length_mm = (end - start).norm();
    Actuator* muscle = nullptr;
    if (random_.uniform() < 0.7)
      muscle = new Muscle(world(), space(), start, start + (end - start) / 3, start + 2 * (end - start) / 3, end, 0.7 * length_mm,
                          random_.uniform(1.0, 1.5) * length_mm);
    else
      muscle = new LinearActuator(world(), space(), start, end, 0.5 * length_mm, 1.3 * length_mm);
    muscle->connectStartTo(nullptr);
    muscle->connectEndTo(parts_[static_cast<std::size_t>(part)]);
    addActuator(muscle);
  }

  RandomStream random_;
  bool spoil_;
  int call_ = 0, spoilt_call_ = 0;
  std::vector<Primitive*> parts_;
};

struct Ends {
  int done = 0, diverged = 0, refused = 0;
};

void run(std::uint64_t seed, bool spoil, Ends& ends) {
  static std::uint64_t current_seed;
  static bool current_spoil;
  current_seed = seed;
  current_spoil = spoil;
  class Built : public RandomRobot {
   public:
    explicit Built(World& world) : RandomRobot(world, current_seed, current_spoil) {}
  };
  SimulationOptions options;
  options.plane = seed % 3 == 0;
  options.stepper = seed % 5 == 0 ? StepperKind::ode : StepperKind::automatic;
  options.substeps = static_cast<int>(1 + seed % 2);
  RandomStream random(seed, "random_robot.pressures");
  try {
    Simulation simulation(options);
    simulation.build<Built>();
    Action action(static_cast<std::size_t>(simulation.robot().actuatorCount()));
    simulation.start("built", action);
    for (int step = 0; step < 200; ++step) {
      for (double& pressure : action) pressure = random.uniform();
      if (step % 20 == 0) simulation.robot().step(action);
      simulation.step();
    }
    for (const double value : simulation.robot().signalValues(simulation.robot().getState())) ASSERT_TRUE(std::isfinite(value)) << seed;
    ++ends.done;
  } catch (const Diverged&) {
    ++ends.diverged;
  } catch (const BadParameter&) {
    ++ends.refused;
  }
}

TEST(RandomRobots, EndDivergeOrAreRefused) {
  const int valid_count = longTests() ? 2000 : 30, invalid_count = longTests() ? 500 : 30;
  Ends valid, invalid;
  for (int i = 0; i < valid_count; ++i) run(static_cast<std::uint64_t>(i), false, valid);
  for (int i = 0; i < invalid_count; ++i) run(static_cast<std::uint64_t>(10000 + i), true, invalid);
  std::printf("valid: %d done, %d diverged, %d refused; spoilt: %d done, %d diverged, %d refused\n", valid.done, valid.diverged,
              valid.refused, invalid.done, invalid.diverged, invalid.refused);
  EXPECT_EQ(valid.done + valid.diverged + valid.refused, valid_count);
  EXPECT_EQ(valid.refused, 0) << "a robot of possible numbers is built";
  EXPECT_GT(valid.done, valid_count / 4);
  EXPECT_GT(invalid.refused, invalid_count / 4);
}

}  // namespace
}  // namespace musclesim
