/// Robots that have no settle of their own: Robot::settle() finds their equilibrium.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "musclesim/base/error.h"
#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double g_N_per_kg = gravity_m_per_s2;

SimulationOptions withText(const std::vector<std::string>& settings) {
  SimulationOptions options;
  for (const std::string& setting : settings) options.parameters.setFromText(setting, "test");
  return options;
}

std::vector<double> valuesOf(Simulation& simulation) {
  return simulation.robot().signalValues(simulation.robot().getState());
}

/// Torque on a hinge in proportion to its angle.
class TorsionSpring : public ForceElement {
 public:
  TorsionSpring(const Joint& hinge, double Nm_per_rad, double rest_rad) : hinge_(hinge), Nm_per_rad_(Nm_per_rad), rest_rad_(rest_rad) {}
  void load(bool, const AddLoad& add) const override {
    dVector3 axis;
    dJointGetHingeAxis(hinge_.id(), axis);
    const double torque_Nmm = -Nm_per_rad_ * (hinge_.angleDeg() * rad_per_deg - rest_rad_) * mm_per_m;
    add(dJointGetBody(hinge_.id(), 0), {Vector::Zero(), torque_Nmm * Vector(axis[0], axis[1], axis[2])});
  }

 private:
  const Joint& hinge_;
  double Nm_per_rad_, rest_rad_;
};

/// Force along y in proportion to the height of a body's centre of mass.
class LinearSpring : public ForceElement {
 public:
  LinearSpring(const Primitive& part, double N_per_mm) : part_(part), N_per_mm_(N_per_mm) {}
  void load(bool, const AddLoad& add) const override {
    add(part_.body().id, {-N_per_mm_ * part_.getPosition().y() * Vector::UnitY(), Vector::Zero()});
  }

 private:
  const Primitive& part_;
  double N_per_mm_;
};

/// 1 kg, 100 mm beside a hinge with a torsion spring, whose rest angle is such that the pendulum rests at -0.4 rad.
class TorsionPendulum : public Robot {
 public:
  explicit TorsionPendulum(World& world) : Robot(world) {
    Box& bar = addBox({.mass_g = 1000, .center_mm = {100, 0, 0}, .size_mm = {200, 20, 20}});
    Joint& hinge = bar.hingeToWorld({.anchor_mm = Vector(0, 0, 0)});
    reportAngle("bar", hinge);
    const double rest_rad = rests_at_rad + g_N_per_kg * 0.1 * std::cos(rests_at_rad) / 2;
    world.addForceElement(std::make_unique<TorsionSpring>(hinge, 2.0, rest_rad));
  }
  static constexpr double rests_at_rad = -0.4;
};

TEST(Settle, ATorsionPendulumRestsWhereSpringAndWeightBalance) {
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original}) {
    SimulationOptions options;
    options.physics = physics;
    Simulation simulation(options);
    Robot& robot = simulation.build<TorsionPendulum>();
    simulation.settle({});
    EXPECT_NEAR(robot.getState().angle_deg[0] * rad_per_deg, TorsionPendulum::rests_at_rad, 1e-12) << nameOf(physics);
  }
}

/// Two links along -y from a hinge at the origin and a hinge at (0, -200, 0), both about z; a pair of muscles at each.
class TwoLinks : public Robot {
 public:
  explicit TwoLinks(World& world) : Robot(world) {
    Box& upper = addBox({.mass_g = 800, .center_mm = {0, -100, 0}, .size_mm = {30, 200, 30}});
    Box& lower = addBox({.mass_g = 500, .center_mm = {0, -290, 0}, .size_mm = {30, 180, 30}});
    reportAngle("shoulder", upper.hingeToWorld({.anchor_mm = Vector(0, 0, 0), .limits_deg = Limits{-80, 80}}));
    reportAngle("elbow", lower.hingeTo(upper, {.anchor_mm = Vector(0, -200, 0), .limits_deg = Limits{-80, 80}}));
    for (const double side : {1.0, -1.0}) {
      addMuscle({.from = fixedAt({side * 45, 200, 0}), .to = upper.at({side * 45, -20, 0}), .length_mm = {120, 320}});
      addMuscle({.from = upper.at({side * 40, -30, 0}), .to = lower.at({side * 40, -215, 0}), .length_mm = {105, 300}});
    }
    setHand(&lower, {0, -90, 0});
  }
};

/// Lengths of the muscles of TwoLinks at two angles, by hand.
std::vector<double> lengthsAt(double shoulder_rad, double elbow_rad) {
  const auto turned = [](double angle_rad, const Vector& v) { return Vector(Eigen::AngleAxisd(angle_rad, Vector::UnitZ()) * v); };
  const Vector elbow = turned(shoulder_rad, {0, -200, 0});
  std::vector<double> lengths;
  for (const double side : {1.0, -1.0}) {
    lengths.push_back((Vector(side * 45, 200, 0) - turned(shoulder_rad, {side * 45, -20, 0})).norm());
    lengths.push_back((turned(shoulder_rad, {side * 40, -30, 0}) - elbow - turned(shoulder_rad + elbow_rad, {side * 40, -15, 0})).norm());
  }
  return lengths;
}

/// Torques in N mm about both hinges of TwoLinks, by virtual work.
Eigen::Vector2d torquesAt(const Robot& robot, const Action& pressure, double shoulder_rad, double elbow_rad) {
  constexpr double d = 1e-5;
  const double upper_N = 0.8 * g_N_per_kg, lower_N = 0.5 * g_N_per_kg;
  Eigen::Vector2d torque(-(upper_N * 100 + lower_N * 200) * std::sin(shoulder_rad) - lower_N * 90 * std::sin(shoulder_rad + elbow_rad),
                         -lower_N * 90 * std::sin(shoulder_rad + elbow_rad));
  const auto lengths = lengthsAt(shoulder_rad, elbow_rad);
  for (std::size_t i = 0; i < 4; ++i) {
    const double tension_N = robot.actuators()[i]->calculateForce(pressure[i], lengths[i]);
    torque[0] -= tension_N * (lengthsAt(shoulder_rad + d, elbow_rad)[i] - lengthsAt(shoulder_rad - d, elbow_rad)[i]) / (2 * d);
    torque[1] -= tension_N * (lengthsAt(shoulder_rad, elbow_rad + d)[i] - lengthsAt(shoulder_rad, elbow_rad - d)[i]) / (2 * d);
  }
  return torque;
}

TEST(Settle, TwoLinksWithFourMusclesRestWhereTheTorquesBalance) {
  Simulation simulation(withText({"muscle.model=line"}));
  Robot& robot = simulation.build<TwoLinks>();
  for (const Action& pressure : {Action{0.8, 0.3, 0.2, 0.9}, Action{0, 0, 0, 0}, Action{1, 0.7, 0.1, 0}}) {
    simulation.settle(pressure);
    const State state = robot.getState();
    const double shoulder_rad = state.angle_deg[0] * rad_per_deg, elbow_rad = state.angle_deg[1] * rad_per_deg;
    EXPECT_LT(torquesAt(robot, pressure, shoulder_rad, elbow_rad).cwiseAbs().maxCoeff(), 1e-4) << "of several 1000 N mm";
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state.length_mm[i], lengthsAt(shoulder_rad, elbow_rad)[i], 1e-9);
    if (pressure[0] > 0) {
      EXPECT_GT(shoulder_rad, 0.1);
    }
  }
}

TEST(Settle, TwoLinksStayWhereTheySettle) {
  for (const char* model : {"muscle.model=line", "muscle.model=chain"}) {
    Simulation simulation(withText({model, "physics.contacts=off"}));
    Robot& robot = simulation.build<TwoLinks>();
    simulation.settle({0.8, 0.3, 0.2, 0.9});
    const State settled = robot.getState();
    EXPECT_GT(std::abs(settled.angle_deg[1]), 5);
    simulation.start("settled", {0.8, 0.3, 0.2, 0.9});
    simulation.advance(0.5);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(robot.getState().angle_deg[i], settled.angle_deg[i], 0.1) << model;
    EXPECT_LT(simulation.largestGap().gap_mm, 0.05) << model;
  }
}

TEST(Settle, HasTheSameBitsFromAnyPose) {
  for (const char* model : {"muscle.model=line", "muscle.model=chain"}) {
    Simulation simulation(withText({model}));
    Robot& robot = simulation.build<TwoLinks>();
    simulation.settle({0.6, 0.3, 0.2, 0.9});
    const auto once = valuesOf(simulation);
    robot.step({0, 1, 1, 0});
    for (int i = 0; i < 20; ++i) simulation.step();
    EXPECT_NE(valuesOf(simulation), once);
    simulation.settle({0.6, 0.3, 0.2, 0.9});
    EXPECT_EQ(valuesOf(simulation), once) << model;
  }
}

TEST(Settle, HasTheSamePoseInAllPhysics) {
  std::vector<std::vector<double>> angles;
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original, PhysicsKind::scaled}) {
    SimulationOptions options;
    options.physics = physics;
    Simulation simulation(options);
    Robot& robot = simulation.build<TwoLinks>();
    simulation.settle({0.8, 0.3, 0.2, 0.9});
    angles.push_back(robot.getState().angle_deg);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(angles[1][i], angles[0][i], 1e-9);
    EXPECT_NEAR(angles[2][i], angles[0][i], 1e-9);
  }
}

/// A ball on a rod that is held to one side, high up.
class BallPendulum : public Robot {
 public:
  explicit BallPendulum(World& world) : Robot(world) {
    Sphere& ball = addSphere({.mass_g = 300, .center_mm = {60, 70, 30}, .radius_mm = 10});
    ball.attachBall(nullptr, {10, 20, 30});
    setHand(&ball);
  }
};

TEST(Settle, APendulumOnABallJointHangsDown) {
  Simulation simulation;
  Robot& robot = simulation.build<BallPendulum>();
  simulation.settle({});
  EXPECT_LT((*robot.getState().hand_mm - Vector(10, 20 - std::sqrt(5000.0), 30)).norm(), 1e-7);
}

TEST(Settle, ALoadHangsAtTheEndOfItsSpring) {
  class Hanging : public Robot {
   public:
    explicit Hanging(World& world) : Robot(world) {
      Box& load = addBox({.mass_g = 2000, .size_mm = {20, 20, 20}});
      load.attachSlider(nullptr, Vector::UnitY());
      world.addForceElement(std::make_unique<LinearSpring>(load, 3.0));
      setHand(&load);
    }
  };
  Simulation simulation;
  Robot& robot = simulation.build<Hanging>();
  simulation.settle({});
  EXPECT_NEAR(robot.getState().hand_mm->y(), -2 * g_N_per_kg / 3, 1e-12);
}

/// Two bars in a horizontal row; their weight turns both hinges to negative angles.
class Row : public Robot {
 public:
  explicit Row(World& world) : Robot(world) {
    Box& inner = addBox({.mass_g = 300, .center_mm = {50, 0, 0}, .size_mm = {100, 10, 10}});
    Box& outer = addBox({.mass_g = 300, .center_mm = {150, 0, 0}, .size_mm = {100, 10, 10}});
    reportAngle("inner", inner.hingeToWorld({.anchor_mm = Vector(0, 0, 0), .limits_deg = Limits{-25, 10}}));
    const double low_deg = -parameter("row.outer_deg", 40, "deg", 0, 170, "lower stop of the outer hinge");
    reportAngle("outer", outer.hingeTo(inner, {.anchor_mm = Vector(100, 0, 0), .limits_deg = Limits{low_deg, 30}}));
  }
};

TEST(Settle, RestsAtItsStops) {
  Simulation both;
  both.build<Row>();
  both.settle({});
  EXPECT_NEAR(both.robot().getState().angle_deg[0], -25, 1e-12);
  EXPECT_NEAR(both.robot().getState().angle_deg[1], -40, 1e-12);
  Simulation one(withText({"row.outer_deg=100"}));
  one.build<Row>();
  one.settle({});
  EXPECT_NEAR(one.robot().getState().angle_deg[0], -25, 1e-12);
  EXPECT_NEAR(one.robot().getState().angle_deg[1], -65, 1e-7) << "hangs down";
}

/// A load that two crossed sliders let move in a plane, on a muscle from the origin.
class CrossedSliders : public Robot {
 public:
  explicit CrossedSliders(World& world) : Robot(world) {
    Box& carriage = addBox({.mass_g = 10, .center_mm = {40, 0, 0}, .size_mm = {20, 20, 20}});
    Box& load = addBox(
        {.mass_g = parameter("load_kg", 50, "kg", 0.1, 100, "load") * g_per_kg, .center_mm = {40, -200, 0}, .size_mm = {20, 20, 20}});
    carriage.attachSlider(nullptr, Vector::UnitX());
    load.attachSlider(&carriage, Vector::UnitY());
    addMuscle({.from = fixedAt({0, 0, 0}), .to = load.at({40, -200, 0}), .length_mm = {120, 300}});
    setHand(&load);
  }
};

TEST(Settle, AChainEndsAtItsLongestLength) {
  Simulation simulation;
  Robot& robot = simulation.build<CrossedSliders>();
  simulation.settle({0.2});
  EXPECT_LT((*robot.getState().hand_mm - Vector(0, -300, 0)).norm(), 1e-5);
  EXPECT_NEAR(robot.getState().length_mm[0], 300, 1e-8);
}

TEST(Settle, ALineIsStretchedBeyondItsLongestLength) {
  Simulation simulation(withText({"muscle.model=line"}));
  Robot& robot = simulation.build<CrossedSliders>();
  simulation.settle({0.2});
  const State state = robot.getState();
  EXPECT_NEAR(state.force_N[0] + 10 * (state.length_mm[0] - 300), 50 * g_N_per_kg, 1e-6) << "10 N/mm beyond the longest length";
}

TEST(Settle, AChainEndsAtItsShortestLength) {
  class Standing : public Robot {
   public:
    explicit Standing(World& world) : Robot(world) {
      Box& load = addBox({.mass_g = 5000, .center_mm = {0, 210, 0}, .size_mm = {20, 20, 20}});
      load.attachSlider(nullptr, Vector::UnitY());
      addMuscle({.from = fixedAt({0, 0, 0}), .to = load.at({0, 210, 0}), .length_mm = {120, 300}});
    }
  };
  Simulation simulation;
  simulation.build<Standing>();
  simulation.settle({0.5});
  EXPECT_NEAR(simulation.robot().getState().length_mm[0], 120, 1e-8);
}

TEST(Settle, AChainThatRunsInACurveIsRefused) {
  class Bow : public Robot {
   public:
    explicit Bow(World& world) : Robot(world) {
      Box& load = addBox({.mass_g = 500, .center_mm = {0, -100, 0}, .size_mm = {20, 20, 20}});
      load.attachSlider(nullptr, Vector::UnitY());
      auto* bow = new Muscle(world, space(), {0, 0, 0}, {150, 0, 0}, {150, -100, 0}, {0, -100, 0}, 150, 300);
      bow->setName("bow");
      bow->connectStartTo(nullptr);
      bow->connectEndTo(&load);
      addActuator(bow);
    }
  };
  Simulation simulation;
  simulation.build<Bow>();
  const std::string message = messageOf<BadParameter>([&] { simulation.settle({0.5}); });
  EXPECT_TRUE(contains(message, "bow is a chain that runs in a curve"));
  EXPECT_TRUE(contains(message, "100 mm apart"));
  EXPECT_TRUE(contains(message, "use built"));
}

TEST(Settle, WhatHasNoEquilibriumIsRefused) {
  class Falling : public Robot {
   public:
    explicit Falling(World& world) : Robot(world) {
      addBox({.mass_g = 1000, .size_mm = {20, 20, 20}, .name = "stone"}).attachSlider(nullptr, Vector::UnitY());
    }
  };
  class FallingPendulum : public Robot {
   public:
    explicit FallingPendulum(World& world) : Robot(world) {
      Box& stone = addBox({.mass_g = 1000, .size_mm = {20, 20, 20}, .name = "stone"});
      stone.attachSlider(nullptr, Vector::UnitY());
      addBox({.mass_g = 100, .center_mm = {50, 0, 0}, .size_mm = {100, 5, 5}}).hingeTo(stone, {.anchor_mm = Vector(0, 0, 0)});
    }
  };
  Simulation one, two;
  one.build<Falling>();
  two.build<FallingPendulum>();
  for (Simulation* simulation : {&one, &two}) {
    const std::string message = messageOf<BadParameter>([&] { simulation->settle({}); });
    EXPECT_TRUE(contains(message, "slider of stone and environment"));
    EXPECT_TRUE(contains(message, simulation == &one ? "-9.81 N " : "-10.8 N "));
    EXPECT_TRUE(contains(message, "--initial-state built"));
    EXPECT_EQ(simulation->world().primitives()[0]->getPosition().y(), 0) << "stays where it was";
  }
}

TEST(Settle, LoopsAndFreeBodiesAreRefused) {
  class Loop : public Robot {
   public:
    explicit Loop(World& world) : Robot(world) {
      Box& left = addBox({.mass_g = 100, .center_mm = {-50, 0, 0}, .size_mm = {100, 5, 5}, .name = "left"});
      Box& right = addBox({.mass_g = 100, .center_mm = {50, 0, 0}, .size_mm = {100, 5, 5}, .name = "right"});
      left.hingeToWorld({.anchor_mm = Vector(-100, 0, 0)});
      right.hingeToWorld({.anchor_mm = Vector(100, 0, 0)});
      left.hingeTo(right, {.anchor_mm = Vector(0, 0, 0)});
    }
  };
  class Free : public Robot {
   public:
    explicit Free(World& world) : Robot(world) { addSphere({.mass_g = 100, .radius_mm = 5, .name = "marble"}); }
  };
  Simulation loop, free;
  loop.build<Loop>();
  free.build<Free>();
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { loop.settle({}); }), "hinge of left and right closes a loop"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { free.settle({}); }), "marble is free"));
}

TEST(Settle, AMuscleWithALooseEndIsRefused) {
  class Loose : public Robot {
   public:
    explicit Loose(World& world) : Robot(world) {
      auto* muscle = new Muscle(world, space(), {0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -210, 0}, 120, 300);
      muscle->connectStartTo(nullptr);
      addActuator(muscle);
    }
  };
  Simulation simulation;
  simulation.build<Loose>();
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.settle({0.5}); }), "the end of muscle_0 is not connected"));
}

/// One to four rods on joints of all kinds, with up to three muscles each.
class RandomTree : public Robot {
 public:
  explicit RandomTree(World& world) : Robot(world), random_(world.seed(), "tree") {
    std::vector<Rod> rods = {{nullptr, Vector::Zero(), Vector::Zero()}};
    const int count = static_cast<int>(between(1, 5));
    for (int i = 0; i < count; ++i) {
      const Rod parent = rods[static_cast<std::size_t>(between(0, i + 0.999))];
      const Vector direction = anywhere().normalized(), to = parent.to + between(80, 200) * direction;
      auto* rod = new CappedCylinder(world, nullptr, (parent.to + to) / 2, between(50, 1500), 0, 8, (to - parent.to).norm());
      join(*rod, parent, direction.unitOrthogonal());
      const int muscles = static_cast<int>(between(0, 4));
      for (int m = 0; m < muscles; ++m) {
        const Vector from = (parent.from + parent.to) / 2 + 50 * anywhere(), end = (parent.to + 2 * to) / 3 + 30 * anywhere();
        const double length_mm = (end - from).norm();
        if (length_mm > 60)
          addMuscle({.from = {parent.body, from}, .to = rod->at(end), .length_mm = {length_mm * 0.7, length_mm * between(1.1, 1.6)}});
      }
      rods.push_back({rod, parent.to, to});
    }
  }

 private:
  struct Rod {
    Primitive* body;
    Vector from, to;
  };
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  Vector anywhere() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  void join(Primitive& rod, const Rod& parent, const Vector& across) {
    const Limits limits = {-between(20, 90), between(20, 90)}, others = {-between(20, 80), between(20, 80)};
    const double kind = between(0, 4);
    if (kind < 1)
      rod.attachBall(parent.body, parent.to);
    else if (kind < 2)
      rod.attachUniversal(parent.body, parent.to, across, across.unitOrthogonal(), limits, others);
    else if (kind < 3 && parent.body)
      parent.body->attachHinge(&rod, parent.to, across, limits.low_deg, limits.high_deg);
    else
      rod.attachHinge(parent.body, parent.to, across, limits.low_deg, limits.high_deg);
  }

  RandomStream random_;
};

TEST(Settle, RandomTreesStayWhereTheySettle) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SimulationOptions options = withText({"muscle.model=line", "physics.contacts=off"});
    options.seed = seed;
    Simulation simulation(options);
    Robot& robot = simulation.build<RandomTree>();
    Action pressure;
    for (int i = 0; i < robot.actuatorCount(); ++i) pressure.push_back(0.1 * static_cast<double>((seed + 3 * i) % 11));
    ASSERT_NO_THROW(simulation.settle(pressure)) << seed;
    std::vector<Vector> settled;
    for (const Primitive* part : simulation.world().primitives()) settled.push_back(part->getPosition());
    robot.step(pressure);
    simulation.advance(0.2);
    for (std::size_t i = 0; i < settled.size(); ++i)
      EXPECT_LT((simulation.world().primitives()[i]->getPosition() - settled[i]).norm(), 2) << "mm, rod " << i << " of tree " << seed;
  }
}

}  // namespace
}  // namespace musclesim
