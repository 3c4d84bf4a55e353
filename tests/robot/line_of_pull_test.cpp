#include "musclesim/robot/line_of_pull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "../../robot/actuator_step.h"
#include "../../robot/ode_vector.h"
#include "../../simulation/snapshot.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions lineOptions(const std::string& more = "") {
  SimulationOptions options;
  options.parameters.setFromText("muscle.model=line", "test");
  if (!more.empty()) options.parameters.setFromText(more, "test");
  return options;
}

/// 120 .. 300 mm long, from `top` down to `bottom`.
Muscle* lineBetween(Simulation& simulation, const Vector& top, const Vector& bottom) {
  return new Muscle(simulation.world(), simulation.space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, 120, 300);
}

TEST(LineMuscle, HasNoLinksAndTheLengthOfItsLine) {
  Simulation simulation(lineOptions());
  const auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  EXPECT_TRUE(muscle->links().empty());
  EXPECT_EQ(muscle->massG(), 0);
  EXPECT_NEAR(muscle->lengthMm(), 210, 1e-12);
}

TEST(LineMuscle, CarriesALoadWhereItsForceEqualsTheWeight) {
  Simulation simulation(lineOptions("rig.load_kg=3"));
  simulation.build("rig");
  simulation.start("settled", {0.6});
  simulation.advance(3);
  const Actuator& muscle = *simulation.world().actuators().front();
  EXPECT_NEAR(muscle.tensionN(), 3 * 9.81, 0.05);
  EXPECT_NEAR(muscle.calculateForce(0.6, muscle.lengthMm()), muscle.tensionN(), 1e-12);
}

TEST(LineMuscle, PullsAtItsViaPointsAlongBothPieces) {
  Simulation simulation(lineOptions());
  auto* ring = new Sphere(simulation.world(), nullptr, {100, -100, 0}, 1000, 0, 5);
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -200, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(nullptr);
  muscle->addViaPoint(ring, {100, -100, 0});
  EXPECT_NEAR(muscle->lengthMm(), 2 * std::sqrt(2e4), 1e-9);
  muscle->setPressure(1);
  simulation.effects().update();
  applyForces(*muscle);
  const dReal* force = dBodyGetForce(ring->body().id);
  const double expected = -std::sqrt(2.0) * muscle->tensionN() * simulation.physics().force_per_N;
  EXPECT_NEAR(force[0], expected, 1e-9 * std::abs(expected)) << "two pieces at 45 degrees pull to the side";
  EXPECT_NEAR(force[1], 0, 1e-9 * std::abs(expected));
}

TEST(LineMuscle, KeepsItsPlacesWhereABodyGetsAPointMass) {
  Simulation simulation(lineOptions());
  auto* bone = new Sphere(simulation.world(), nullptr, {0, -250, 0}, 1000, 0, 5);
  bone->rotate(30, {1, 2, 0});
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -200, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(bone);
  bone->addPointMass(500, {90, -300, 10});
  EXPECT_GT(bone->getPosition().x(), 20);
  EXPECT_NEAR(muscle->lengthMm(), 200, 1e-12);
}

TEST(LineMuscle, ConservesMomentumBetweenTwoBodies) {
  Simulation simulation(lineOptions("physics.gravity_m_per_s2=0"));
  auto* heavy = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 1000, 0, 20);
  auto* light = new Sphere(simulation.world(), nullptr, {0, -220, 0}, 300, 0, 20);
  auto* muscle = lineBetween(simulation, {5, 0, 0}, {0, -210, 3});
  muscle->connectStartTo(heavy);
  muscle->connectEndTo(light);
  muscle->setPressure(0.7);
  for (int i = 0; i < 30; ++i) simulation.step();
  const dReal *v = dBodyGetLinearVel(heavy->body().id), *w = dBodyGetLinearVel(light->body().id);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(1000 * v[i] + 300 * w[i], 0, 1e-6);
  EXPECT_LT(muscle->lengthMm(), 205);
}

TEST(LineMuscle, StopsBeyondItsLongestLength) {
  SimulationOptions options = lineOptions("rig.load_kg=50");
  options.parameters.setFromText("muscle.slider_friction_N=100", "test");  // so that it comes to rest
  Simulation simulation(std::move(options));
  simulation.build("rig");
  simulation.start("built", {0.0});
  simulation.advance(10);
  // F(0, l) + 10 N/mm (l - 300 mm) carries 490 N.
  const Actuator& muscle = *simulation.world().actuators().front();
  EXPECT_NEAR(muscle.tensionN() + 10 * (muscle.lengthMm() - 300), 50 * 9.81, 2);
}

TEST(LineMuscle, SlackLinesDoNotPush) {
  Simulation simulation(lineOptions());
  auto* load = new Sphere(simulation.world(), nullptr, {0, -210, 0}, 1000, 0, 5);
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(load);
  load->place({0, -60, 0}, Eigen::Matrix3d::Identity());
  muscle->setPressure(1);
  simulation.effects().update();
  EXPECT_LT(muscle->calculateForce(1, 60), 0) << "Eq. 1 continued below the shortest length";
  EXPECT_EQ(muscle->tensionN(), 0);
}

TEST(LineMuscle, TwiceConnectedEndsAndViaPointsOfChainsAreRefused) {
  Simulation simulation(lineOptions());
  auto* line = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  line->connectEndTo(nullptr);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { line->connectEndTo(nullptr); }), "already connected"));
  Simulation chains;
  auto* chain = lineBetween(chains, {0, 0, 0}, {0, -210, 0});
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { chain->addViaPoint(nullptr, {0, 0, 0}); }), "is a chain"));
}

TEST(LineMuscle, IsNotTiedToAnotherSimulation) {
  Simulation simulation(lineOptions()), other(lineOptions());
  auto* line = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  auto* bone = new Sphere(other.world(), nullptr, {0, -210, 0}, 1000, 0, 5);
  for (const auto& tie : std::vector<std::function<void()>>{[&] { line->connectStartTo(bone); }, [&] { line->connectEndTo(bone); },
                                                            [&] {
                                                              line->addViaPoint(bone, {0, -100, 0});
                                                            }})
    EXPECT_TRUE(contains(messageOf<BadParameter>(tie), "different simulations"));
}

/// A straight line muscle with a wide range of lengths.
LinearActuator* threadBetween(Simulation& simulation, Primitive* from, const Vector& start, Primitive* to, const Vector& end) {
  auto* thread = new LinearActuator(simulation.world(), simulation.space(), start, end, 10, 1000);
  thread->connectStartTo(from);
  thread->connectEndTo(to);
  return thread;
}

Eigen::Matrix3d turnBy(double angle_rad, const Vector& axis) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

/// Force and torque on a body, the torque about a point, summed over all pushes.
std::pair<Vector, Vector> pushOn(dBodyID body, const Vector& point, const LineOfPull& line) {
  Vector force = Vector::Zero(), torque = Vector::Zero();
  for (const auto& push : line.pushes()) {
    if (push.body != body) continue;
    force += push.force;
    torque += push.torque + (positionOf(body) - point).cross(push.force);
  }
  return {force, torque};
}

/// A bone on a hinge in the origin, and a muscle from the environment over a pulley on the hinge's axis to the bone.
struct HingeWithPulley {
  static constexpr double radius_mm = 30;
  explicit HingeWithPulley(bool on_bone, const Vector& axis = Vector::UnitZ())
      : bone(new Box(simulation.world(), nullptr, {100, 0, 0}, 500, 0, 200, 20, 20)),
        thread(threadBetween(simulation, nullptr, {-120, 20, 0}, bone, {120, 10, 15})) {
    bone->attachHinge(nullptr, {0, 0, 0}, {0, 0, 1});
    thread->addPulley(on_bone ? bone : nullptr, {0, 0, 5}, axis, radius_mm, Vector(0, 40, 5));
  }
  void turnTo(double angle_deg) {
    const Eigen::Matrix3d turn = turnBy(angle_deg * rad_per_deg, Vector::UnitZ());
    bone->place(turn * Vector(100, 0, 0), turn);
  }
  /// dl/d(angle of the hinge)
  double leverMm() const { return pushOn(bone->body().id, Vector::Zero(), *thread->line()).second.z(); }
  bool wound() const { return thread->line()->pointsMm().size() > 2; }

  Simulation simulation{lineOptions()};
  Box* bone;
  LinearActuator* thread;
};

TEST(MuscleOverPulley, HasAConstantLeverArmWhileItLiesOnAPulleyOnTheHinge) {
  for (const bool on_bone : {false, true}) {
    HingeWithPulley hinge(on_bone);
    const double planar_share = [&] {  // the slope of the helix takes its share of the force
      hinge.turnTo(0);
      const auto points = hinge.thread->line()->pointsMm();
      const Vector first = points[1] - points[0];
      return std::hypot(first.x(), first.y()) / first.norm();
    }();
    EXPECT_LT(planar_share, 0.9999);
    for (double angle_deg = -150; angle_deg <= 10; angle_deg += 7) {
      hinge.turnTo(angle_deg);
      ASSERT_TRUE(hinge.wound());
      const double planar_mm = std::sqrt(std::pow(hinge.thread->lengthMm(), 2) - 15 * 15);
      EXPECT_NEAR(hinge.leverMm(), -30 * planar_mm / hinge.thread->lengthMm(), 30e-9) << angle_deg;
    }
  }
}

TEST(MuscleOverPulley, LiftsOffWithoutAJumpOfItsLeverArm) {
  HingeWithPulley hinge(true);
  double last_mm = 0;
  int wound_count = 0, step_count = 0;
  for (double angle_deg = 0; angle_deg <= 60; angle_deg += 0.01, ++step_count) {
    hinge.turnTo(angle_deg);
    wound_count += hinge.wound() ? 1 : 0;
    const double now_mm = hinge.leverMm();
    if (step_count > 0) {
      EXPECT_NEAR(now_mm, last_mm, 0.03) << angle_deg;
    }
    last_mm = now_mm;
  }
  EXPECT_GT(wound_count, 500);
  EXPECT_LT(wound_count, step_count - 500);
}

/// A thread between two free bodies past a pulley on a third one.
struct FreeBodies {
  explicit FreeBodies(const Vector& axis, std::optional<Vector> side) {
    const Vector centers[3] = {{-120, 30, 10}, {110, -25, 30}, {10, -20, 5}};
    for (const Vector& center : centers) bodies.push_back(new Box(simulation.world(), nullptr, center, 300, 0, 40, 30, 20));
    bodies[2]->rotate(25, {1, 2, 3});
    thread = threadBetween(simulation, bodies[0], {-110, 20, 0}, bodies[1], {100, 15, 25});
    thread->addPulley(bodies[2], {5, -5, 8}, axis, 25, side);
  }
  Simulation simulation{lineOptions()};
  std::vector<Primitive*> bodies;
  LinearActuator* thread;
};

TEST(MuscleOverPulley, PushesItsBodiesByTheGradientOfItsLength) {
  constexpr double h = 1e-4;
  for (const Vector& axis : {Vector(0.2, -0.1, 1), Vector(0, 0, 0)})
    for (const auto& side : {std::optional<Vector>(), std::optional<Vector>(Vector(0, -60, 0))}) {
      FreeBodies free(axis, side);
      ASSERT_GT(free.thread->line()->pointsMm().size(), 2u);
      for (Primitive* body : free.bodies) {
        const Vector center = body->getPosition();
        const Eigen::Matrix3d rotation = body->getRotation();
        const auto lengthAt = [&](const Vector& shift, const Eigen::Matrix3d& turn) {
          body->place(center + shift, turn * rotation);
          const double length_mm = free.thread->lengthMm();
          body->place(center, rotation);
          return length_mm;
        };
        const auto [force, torque] = pushOn(body->body().id, center, *free.thread->line());
        const Eigen::Matrix3d still = Eigen::Matrix3d::Identity();
        for (int i = 0; i < 3; ++i) {
          const Vector e = Vector::Unit(i);
          EXPECT_NEAR((lengthAt(h * e, still) - lengthAt(-h * e, still)) / (2 * h), force[i], 1e-7);
          EXPECT_NEAR((lengthAt({0, 0, 0}, turnBy(h, e)) - lengthAt({0, 0, 0}, turnBy(-h, e))) / (2 * h), torque[i], 1e-5);
        }
      }
    }
}

TEST(MuscleOverPulley, ExertsForcesAndTorquesThatSumToZero) {
  for (const Vector& axis : {Vector(0.2, -0.1, 1), Vector(0, 0, 0)}) {
    FreeBodies free(axis, {});
    free.thread->setPressure(0.8);
    free.simulation.effects().update();
    EXPECT_GT(free.thread->tensionN(), 10);
    applyForces(*free.thread);
    Vector force = Vector::Zero(), torque = Vector::Zero();
    double largest = 0;
    for (const Primitive* body : free.bodies) {
      const Vector f = fromOde(dBodyGetForce(body->body().id));
      force += f;
      torque += body->getPosition().cross(f) + fromOde(dBodyGetTorque(body->body().id));
      largest = std::max(largest, f.norm());
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(force.norm(), 1e-12 * largest);
    EXPECT_LT(torque.norm(), 1e-10 * largest);
  }
}

TEST(MuscleOverPulley, PullsAPulleyAtItsTwoTangentPoints) {
  Simulation simulation(lineOptions());
  auto* wheel = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 500, 0, 30);
  auto* thread = threadBetween(simulation, nullptr, {-30, -200, 0}, nullptr, {30, -200, 0});
  thread->addPulley(wheel, {0, 0, 0}, {0, 0, 1}, 30, Vector(0, 50, 0));
  EXPECT_NEAR(thread->lengthMm(), 400 + 30 * std::numbers::pi, 1e-12);
  const auto [force, torque] = pushOn(wheel->body().id, Vector::Zero(), *thread->line());
  EXPECT_LT((force - Vector(0, 2, 0)).norm(), 1e-14) << "raising the wheel lengthens both sides";
  EXPECT_LT(torque.norm(), 1e-12);
}

/// Two bones in a row on hinges, with a flexor and an extensor each over pulleys on the hinges.
class ArmWithPulleys : public Robot {
 public:
  explicit ArmWithPulleys(World& world) : Robot(world) {
    Box& upper = addBox({.mass_g = 800, .center_mm = {100, 0, 0}, .size_mm = {200, 20, 20}});
    Box& lower = addBox({.mass_g = 500, .center_mm = {300, 0, 0}, .size_mm = {200, 20, 20}});
    reportAngle("shoulder", upper.hingeToWorld({.anchor_mm = Vector(0, 0, 0), .limits_deg = Limits{-120, 120}}));
    reportAngle("elbow", lower.hingeTo(upper, {.anchor_mm = Vector(200, 0, 0), .limits_deg = Limits{-120, 120}}));
    for (const double side : {1, -1}) {
      muscle(fixedAt({-180, 20 * side, 0}), upper.at({120, 15 * side, 5}), nullptr, {0, 0, 0}, side);
      muscle(upper.at({40, 15 * side, 0}), lower.at({310, 15 * side, 5}), &upper, {200, 0, 0}, side);
    }
  }

 private:
  void muscle(const Attachment& from, const Attachment& to, Primitive* wheel, const Vector& center, double side) {
    Actuator& muscle = addMuscle({.from = from, .to = to, .length_mm = {200, 380}});
    muscle.addPulley(wheel, center, Vector::UnitZ(), 30, Vector(center + Vector(0, 40 * side, 0)));
  }
};

TEST(MuscleOverPulley, MovesAlikeUnderBothSteppers) {
  std::vector<std::vector<double>> angles;
  for (const StepperKind stepper : {StepperKind::ode, StepperKind::chain}) {
    SimulationOptions options = lineOptions();
    options.stepper = stepper;
    options.substeps = 20;
    Simulation simulation(std::move(options));
    Robot& robot = simulation.build<ArmWithPulleys>();
    simulation.start("built", {0.5, 0.7, 0.4, 0.2});
    for (int i = 0; i < 30; ++i) simulation.step();
    angles.push_back(robot.getState().angle_deg);
    EXPECT_GT(std::abs(angles.back()[0]), 5);
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(angles[0][i], angles[1][i], 1e-4);
}

TEST(MuscleOverPulley, IsDrawnOnItsPulley) {
  Simulation simulation(lineOptions());
  Robot& robot = simulation.build<ArmWithPulleys>();
  const Snapshot snapshot = SnapshotTaker(simulation).take(robot.getState());
  ASSERT_EQ(snapshot.hoses.size(), 4u);
  for (const DrawnHose& hose : snapshot.hoses) EXPECT_GT(hose.points_mm.size(), 3u) << "both ends and points on the pulley";
}

TEST(MuscleOverPulley, ChoosesAStepInWhichItsRobotIsStable) {
  SimulationOptions options = lineOptions();
  options.step_s = 0.05;
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build<ArmWithPulleys>();
  EXPECT_GT(simulation.substeps(), 5);
  simulation.start("built", {1, 0, 0, 1});
  for (int i = 0; i < 100; ++i) {
    simulation.step();
    if (i % 20 == 0) robot.step(i % 40 == 0 ? Action{0, 1, 1, 0} : Action{1, 1, 1, 1});
  }
  EXPECT_LT(simulation.worstGap().gap_mm, 1);
}

TEST(LineMuscle, KeepsItsPlacesOnABodyThatCarriesAPointMass) {
  FreeBodies free({0.2, -0.1, 1}, Vector(0, -60, 0));
  const std::vector<Vector> before = free.thread->line()->pointsMm();
  for (Primitive* body : free.bodies) body->addPointMass(200, body->getPosition() + Vector(10, 20, -5));
  const std::vector<Vector> after = free.thread->line()->pointsMm();
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((after[i] - before[i]).norm(), 1e-10) << i;
}

TEST(LineMuscle, IsShorterThanItsPathByItsTendon) {
  Simulation simulation(lineOptions("muscle.slider_friction_N=0"));
  auto* load = new Sphere(simulation.world(), nullptr, {0, -350, 0}, 1000, 0, 5);
  auto* muscle = new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, -350, 0}, 120, 300);
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(load);
  muscle->setTendonMm(100);
  EXPECT_EQ(muscle->lengthMm(), 250);
  EXPECT_EQ(muscle->tensionN(), muscle->calculateForce(0, 250));
  load->place({0, -410, 0}, Eigen::Matrix3d::Identity());
  EXPECT_EQ(muscle->lengthMm(), 310);
  applyForces(*muscle);
  const double stop_N = dBodyGetForce(load->body().id)[1] / simulation.physics().force_per_N - muscle->tensionN();
  EXPECT_NEAR(stop_N, 10 * 10.0, 1e-9) << "10 mm beyond the longest length of the muscle";
}

TEST(LineMuscle, IsCheckedWhenItsPathIsFinished) {
  const auto stepped = [](double tendon_mm, bool with_via_point) {
    Simulation simulation(lineOptions());
    auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -310, 0});
    muscle->setName("triceps");
    if (with_via_point) muscle->addViaPoint(nullptr, {200, -100, 0});
    muscle->setTendonMm(tendon_mm);
    return messageOf<BadParameter>([&] { simulation.step(); });
  };
  const auto longer = stepped(0, false);
  EXPECT_TRUE(contains(longer, "start length of triceps along its path = 310 mm: must lie between"));
  EXPECT_TRUE(contains(longer, "120 .. 300 mm"));
  EXPECT_EQ(stepped(10.5, false), "nothing was thrown");
  EXPECT_TRUE(contains(stepped(200, false), "start length of triceps, without its tendon of 200 mm, along its path = 110 mm"));
  EXPECT_TRUE(contains(stepped(0, true), "513.6 mm"));
  EXPECT_EQ(stepped(300, true), "nothing was thrown");
}

TEST(LineMuscle, ItsPathDoesNotChangeAfterwards) {
  Simulation simulation(lineOptions());
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  simulation.step();
  for (const auto& change : std::vector<std::function<void()>>{[&] {
                                                                 muscle->addViaPoint(nullptr, {0, 0, 0});
                                                               },
                                                               [&] {
                                                                 muscle->addPulley(nullptr, {0, 0, 0}, {0, 0, 1}, 10);
                                                               },
                                                               [&] { muscle->setTendonMm(10); }})
    EXPECT_TRUE(contains(messageOf<BadParameter>(change), "of muscle_0 comes too late"));
}

TEST(MuscleOverPulley, RefusesWhatCannotBe) {
  Simulation simulation(lineOptions()), other(lineOptions()), chains;
  auto* thread = threadBetween(simulation, nullptr, {0, 0, 0}, nullptr, {0, -200, 0});
  auto* bone = new Sphere(other.world(), nullptr, {0, 0, 0}, 1000, 0, 5);
  const Vector center(20, -100, 0), z(0, 0, 1);
  const auto refusal = [&](Actuator* muscle, Primitive* primitive, const Vector& at, const Vector& axis, double radius_mm,
                           std::optional<Vector> side_mm = {}) {
    return messageOf<BadParameter>([&] { muscle->addPulley(primitive, at, axis, radius_mm, side_mm); });
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(contains(refusal(lineBetween(chains, {0, 0, 0}, {0, -210, 0}), nullptr, center, z, 10), "is a chain"));
  EXPECT_TRUE(contains(refusal(thread, bone, center, z, 10), "different simulations"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, center, z, 0), "pulley of muscle_0: radius = 0 mm: must be positive"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, center, z, nan), "must be positive"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, {nan, 0, 0}, z, 10), "center"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, center, {0, nan, 0}, 10), "axis"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, center, z, 10, Vector(0, 0, nan)), "side point"));
  EXPECT_TRUE(contains(refusal(thread, nullptr, center, z, 10, Vector(20, -91, 70)), "9 mm: must be at least its radius, 10 mm"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { thread->setTendonMm(-1); }), "tendon of muscle_0 = -1 mm"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { thread->setTendonMm(nan); }), "tendon of muscle_0"));
  auto* chain = chains.world().actuators().front();
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { chain->setTendonMm(1); }), "is a chain"));

  thread->addPulley(nullptr, center, 5 * z, 30);
  EXPECT_TRUE(contains(refusal(thread, nullptr, {0, -150, 0}, z, 10), "there must be a via point between them"));
  thread->addViaPoint(nullptr, {0, -120, 0});
  thread->addPulley(nullptr, {0, -160, 0}, z, 10);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.step(); }),
                       "distance of point 1 of muscle_0 from the pulley beside it = 28.28 mm: must be at least the radius, 30 mm"));
}

TEST(MuscleOverPulley, GoesOnWhereAnEndGetsIntoThePulley) {
  Simulation simulation(lineOptions());
  auto* load = new Sphere(simulation.world(), nullptr, {200, 0, 0}, 1000, 0, 5);
  auto* thread = threadBetween(simulation, nullptr, {-100, 0, 0}, load, {200, 0, 0});
  thread->addPulley(nullptr, {0, 0, 0}, {0, 0, 1}, 30, Vector(0, 40, 0));
  simulation.step();
  load->place({0, 0, 0}, Eigen::Matrix3d::Identity());
  EXPECT_EQ(thread->lengthMm(), 100);
  simulation.step();
  EXPECT_TRUE(std::isfinite(thread->lengthMm()));
}

}  // namespace
}  // namespace musclesim
