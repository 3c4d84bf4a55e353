#include "musclesim/robot/joint.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions weightless() {
  SimulationOptions options;
  options.step_s = 1e-3;
  options.substeps = 1;
  options.parameters.set("physics.gravity_m_per_s2", 0.0, "test");
  return options;
}

/// A box at the origin beside a fixed one, without gravity.
struct Pair {
  Simulation simulation{weightless()};
  Primitive* base = new Box(simulation.world(), nullptr, {0, 100, 0}, 100, 0, 50, 50, 50);
  Primitive* body = new Box(simulation.world(), nullptr, {0, 0, 0}, 100, 0, 60, 50, 40);

  Pair() { base->fix(); }

  /// Applies a torque about an axis of the world for half a second and returns the body's rotation about that axis.
  double pushDeg(const Vector& axis, double torque_Nmm) {
    const Vector torque = torque_Nmm * world_force_per_N * axis.normalized();
    double last_rad = 0, turned_rad = 0;
    for (int i = 0; i < 500; ++i) {
      dBodyAddTorque(body->body().id, torque.x(), torque.y(), torque.z());
      simulation.step();
      const Vector across = axis.normalized().unitOrthogonal();
      const Vector now = body->getRotation() * across;
      const double angle_rad = std::atan2(axis.normalized().dot(across.cross(now)), across.dot(now));
      turned_rad += std::remainder(angle_rad - last_rad, 2 * std::numbers::pi);
      last_rad = angle_rad;
    }
    return turned_rad * deg_per_rad;
  }
};

constexpr double push_Nmm = 2;
constexpr double tolerance_deg = 0.3;

/// A test case: how to make a joint, and what should happen about one of its axes.
struct Case {
  std::string name;
  std::function<Joint*(Pair&)> attach;
  Vector axis;
  enum { free, limited, locked } behaviour;
  double low_deg = 0, high_deg = 0;
  int reported_axis = -1;  ///< index for Joint::angleDeg
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

std::vector<Case> cases() {
  const Vector x = Vector::UnitX(), y = Vector::UnitY(), z = Vector::UnitZ(), o = Vector::Zero();
  const Limits first{-20, 35}, second{-25, 40}, third{-15, 30};
  const Vector slanted = Vector(1, 2, -0.5);
  std::vector<Case> all;
  for (const bool to_base : {false, true}) {
    const std::string to = to_base ? " to a body" : " to the environment";
    auto other = [to_base](Pair& p) { return to_base ? p.base : nullptr; };
    auto ball = [=](Pair& p) { return p.body->attachBall(other(p), o); };
    auto limited_ball = [=](Pair& p) { return p.body->attachBall(other(p), o, x, z, first, second, third); };
    auto hinge = [=](Pair& p) { return p.body->attachHinge(other(p), o, slanted); };
    auto limited_hinge = [=](Pair& p) { return p.body->attachHinge(other(p), o, slanted, first.low_deg, first.high_deg); };
    auto universal = [=](Pair& p) { return p.body->attachUniversal(other(p), o, x, z); };
    auto limited_universal = [=](Pair& p) { return p.body->attachUniversal(other(p), o, x, z, first, second); };
    auto one_axis = [=](Pair& p) { return p.body->attachUniversal(other(p), o, z); };
    auto limited_one_axis = [=](Pair& p) { return p.body->attachUniversal(other(p), o, z, first.low_deg, first.high_deg); };
    for (const Vector& axis : {x, y, z}) all.push_back({"ball about any axis" + to, ball, axis, Case::free});
    all.push_back({"ball, first limits" + to, limited_ball, x, Case::limited, first.low_deg, first.high_deg});
    all.push_back({"ball, second limits" + to, limited_ball, z.cross(x), Case::limited, second.low_deg, second.high_deg});
    all.push_back({"ball, third limits" + to, limited_ball, z, Case::limited, third.low_deg, third.high_deg});
    all.push_back({"hinge" + to, hinge, slanted, Case::free, 0, 0, 0});
    all.push_back({"hinge, limits" + to, limited_hinge, slanted, Case::limited, first.low_deg, first.high_deg, 0});
    all.push_back({"hinge across its axis" + to, hinge, slanted.unitOrthogonal(), Case::locked});
    all.push_back({"universal, first axis" + to, universal, x, Case::free, 0, 0, 0});
    all.push_back({"universal, second axis" + to, universal, z, Case::free, 0, 0, 1});
    all.push_back({"universal across both axes" + to, universal, y, Case::locked});
    all.push_back({"universal, first limits" + to, limited_universal, x, Case::limited, first.low_deg, first.high_deg, 0});
    all.push_back({"universal, second limits" + to, limited_universal, z, Case::limited, second.low_deg, second.high_deg, 1});
    all.push_back({"universal with one axis" + to, one_axis, z, Case::free, 0, 0, 0});
    all.push_back({"universal with one axis, across x" + to, one_axis, x, Case::locked});
    all.push_back({"universal with one axis, across y" + to, one_axis, y, Case::locked});
    all.push_back({"universal with one axis, limits" + to, limited_one_axis, z, Case::limited, first.low_deg, first.high_deg, 0});
  }
  auto hinge2 = [=](Pair& p) { return p.body->attachHinge(p.base, o, y, z); };
  auto limited_hinge2 = [=](Pair& p) { return p.body->attachHinge(p.base, o, y, z, first, second); };
  all.push_back({"hinge with two axes, first", hinge2, y, Case::free, 0, 0, 0});
  all.push_back({"hinge with two axes, second", hinge2, z, Case::free, 0, 0, 1});
  all.push_back({"hinge with two axes, across both", hinge2, x, Case::locked});
  all.push_back({"hinge with two axes, first limits", limited_hinge2, y, Case::limited, first.low_deg, first.high_deg, 0});
  all.push_back({"hinge with two axes, second limits", limited_hinge2, z, Case::limited, second.low_deg, second.high_deg, 1});
  return all;
}

class JointAxis : public ::testing::TestWithParam<Case> {};

TEST_P(JointAxis, MovesOrHoldsUnderATorqueInBothDirections) {
  const Case& c = GetParam();
  for (const double sign : {1.0, -1.0}) {
    Pair pair;
    const Joint* joint = c.attach(pair);
    const double turned_deg = pair.pushDeg(c.axis, sign * push_Nmm);
    if (c.behaviour == Case::free) {
      EXPECT_GT(sign * turned_deg, 90);
    }
    if (c.behaviour == Case::locked) {
      EXPECT_NEAR(turned_deg, 0, tolerance_deg);
    }
    if (c.behaviour == Case::limited) {
      EXPECT_NEAR(turned_deg, sign > 0 ? c.high_deg : c.low_deg, tolerance_deg);
    }
    if (c.reported_axis >= 0) {
      const double reported_deg = joint->angleDeg(c.reported_axis);
      EXPECT_NEAR(std::remainder(reported_deg - turned_deg, 360), 0, 1e-3) << "reported " << reported_deg << ", turned " << turned_deg;
      const auto [low_deg, high_deg] = joint->stopsDeg(c.reported_axis);
      const bool own_stops = c.behaviour == Case::limited && !(joint->kind() == Joint::Kind::hinge2 && c.reported_axis == 1);
      if (own_stops) {
        EXPECT_NEAR(low_deg, c.low_deg, 1e-9);
        EXPECT_NEAR(high_deg, c.high_deg, 1e-9);
      } else {
        EXPECT_TRUE(std::isinf(low_deg) && std::isinf(high_deg)) << low_deg << " .. " << high_deg;
      }
    }
    EXPECT_LT(joint->constraintErrorMm(), 0.01);
    EXPECT_LT((pair.body->getPosition()).norm(), 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(All, JointAxis, ::testing::ValuesIn(cases()), [](const auto& tested) {
  std::string name = std::to_string(tested.index) + "_" + tested.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(Joint, AnglesAreOfTheFirstBodyAgainstTheSecond) {
  Pair pair;
  auto* forearm = new Box(pair.simulation.world(), nullptr, {0, -60, 0}, 50, 0, 20, 60, 20);
  pair.body->attachHinge(nullptr, {0, 0, 0}, {0, 0, 1});
  const Joint* elbow = pair.body->attachHinge(forearm, {0, -30, 0}, {0, 0, 1});
  for (int i = 0; i < 100; ++i) {
    dBodyAddTorque(pair.body->body().id, 0, 0, push_Nmm * world_force_per_N);
    pair.simulation.step();
  }
  const Eigen::Matrix3d relative = forearm->getRotation().transpose() * pair.body->getRotation();
  EXPECT_NEAR(elbow->angleDeg(), std::atan2(relative(1, 0), relative(0, 0)) * deg_per_rad, 1e-6);
  EXPECT_GT(std::abs(elbow->angleDeg()), 1);
}

TEST(Joint, SliderMovesAlongItsAxisOnlyAndKeepsTheBodyFromTurning) {
  for (const bool to_base : {false, true}) {
    Pair pair;
    const Vector axis(1, 1, 0);
    const Joint* slider = pair.body->attachSlider(to_base ? pair.base : nullptr, axis);
    for (int i = 0; i < 200; ++i) {
      dBodyAddForce(pair.body->body().id, 3e5, 0, 2e5);
      dBodyAddTorque(pair.body->body().id, 1e6, 1e6, 1e6);
      pair.simulation.step();
    }
    const Vector moved = pair.body->getPosition();
    EXPECT_GT(moved.dot(axis.normalized()), 20);
    EXPECT_LT((moved - axis.normalized() * moved.dot(axis.normalized())).norm(), 0.01);
    EXPECT_TRUE(pair.body->getRotation().isApprox(Eigen::Matrix3d::Identity(), 1e-3));
    EXPECT_LT(slider->constraintErrorMm(), 0.01);
    EXPECT_THROW(slider->angleDeg(), BadParameter);
  }
}

TEST(Joint, GapIsTheDistanceOfTheTornAnchors) {
  Pair pair;
  auto anchored = [&](const std::function<Joint*(Primitive*)>& attach) {
    auto* body = new Sphere(pair.simulation.world(), nullptr, {0, 0, 0}, 10, 0, 5);
    const Joint* joint = attach(body);
    EXPECT_NEAR(joint->constraintErrorMm(), 0, 1e-12);
    body->place({3, 0, 4}, Eigen::Matrix3d::Identity());
    return joint->constraintErrorMm();
  };
  const Vector o = Vector::Zero(), x = Vector::UnitX(), z = Vector::UnitZ();
  EXPECT_NEAR(anchored([&](Primitive* b) { return b->attachBall(nullptr, o); }), 5, 1e-12);
  EXPECT_NEAR(anchored([&](Primitive* b) { return b->attachHinge(nullptr, o, z); }), 5, 1e-12);
  EXPECT_NEAR(anchored([&](Primitive* b) { return b->attachHinge(pair.base, o, x, z); }), 5, 1e-12);
  EXPECT_NEAR(anchored([&](Primitive* b) { return b->attachUniversal(nullptr, o, x, z); }), 5, 1e-12);
  EXPECT_NEAR(anchored([&](Primitive* b) { return b->attachSlider(nullptr, x); }), 4, 1e-12) << "across the axis only";
  auto* fixed = new Sphere(pair.simulation.world(), nullptr, {0, 0, 0}, 10, 0, 5);
  fixed->fix();
  fixed->place({3, 0, 4}, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(pair.simulation.largestGap().gap_mm, 5, 1e-12);
}

TEST(Joint, IsNamedAfterWhatItJoins) {
  Pair pair;
  pair.body->setName("hand");
  pair.base->setName("radius");
  EXPECT_EQ(pair.body->attachHinge(pair.base, {0, 0, 0}, {0, 0, 1})->name(), "hinge of hand and radius");
  EXPECT_EQ(pair.body->attachBall(nullptr, {0, 0, 0})->name(), "ball joint of hand and environment");
}

TEST(Joint, HasNoAngleAboutAnAxisThatItLacks) {
  Pair pair;
  const Joint* hinge = pair.body->attachHinge(pair.base, {0, 0, 0}, {0, 0, 1});
  EXPECT_EQ(hinge->angleDeg(0), 0);
  EXPECT_THROW(hinge->angleDeg(1), BadParameter);
  EXPECT_THROW(hinge->angleDeg(-1), BadParameter);
  EXPECT_THROW(hinge->stopsDeg(1), BadParameter);
  EXPECT_THROW(pair.body->attachBall(nullptr, {0, 0, 0})->angleDeg(), BadParameter);
}

TEST(Joint, EveryWayToAttachRefusesNumbersThatCannotBe) {
  const Vector o = Vector::Zero(), x = Vector::UnitX(), y = Vector::UnitY(), z = Vector::UnitZ();
  const Limits fine{-10, 10};
  Pair pair;
  Primitive *a = pair.body, *b = pair.base;
  const auto joints_before = pair.simulation.world().joints().size();
  for (const double wrong : {nan, inf, -inf}) {
    const Vector v(0, wrong, 0);
    EXPECT_THROW(a->attachBall(b, v), BadParameter);
    EXPECT_THROW(a->attachBall(b, v, x, z, fine, fine, fine), BadParameter);
    EXPECT_THROW(a->attachBall(b, o, v, z, fine, fine, fine), BadParameter);
    EXPECT_THROW(a->attachBall(b, o, x, v, fine, fine, fine), BadParameter);
    EXPECT_THROW(a->attachHinge(b, v, z), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, v), BadParameter);
    EXPECT_THROW(a->attachHinge(b, v, x, z), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, v, z), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, x, v), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, v, x, z), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, v, z), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, x, v), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, v, z), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, v), BadParameter);
    EXPECT_THROW(a->attachSlider(b, v), BadParameter);
  }
  for (const Limits& wrong : {Limits{nan, 10}, Limits{-10, nan}, Limits{-inf, 10}, Limits{-10, inf}, Limits{10, -10}}) {
    EXPECT_THROW(a->attachBall(b, o, x, z, wrong, fine, fine), BadParameter);
    EXPECT_THROW(a->attachBall(b, o, x, z, fine, wrong, fine), BadParameter);
    EXPECT_THROW(a->attachBall(b, o, x, z, fine, fine, wrong), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, z, wrong.low_deg, wrong.high_deg), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, y, z, wrong, fine), BadParameter);
    EXPECT_THROW(a->attachHinge(b, o, y, z, fine, wrong), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, x, z, wrong, fine), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, x, z, fine, wrong), BadParameter);
    EXPECT_THROW(a->attachUniversal(b, o, z, wrong.low_deg, wrong.high_deg), BadParameter);
  }
  EXPECT_THROW(a->attachHinge(b, o, o), BadParameter) << "no direction";
  EXPECT_THROW(a->attachHinge(b, o, z, z), BadParameter) << "parallel axes";
  EXPECT_THROW(a->attachHinge(nullptr, o, x, z), BadParameter) << "two axes need two bodies";
  EXPECT_THROW(a->attachUniversal(b, o, x, Vector(1, 0, 1)), BadParameter) << "axes that are not perpendicular";
  EXPECT_THROW(a->attachBall(b, o, x, Vector(1, 0, 1), fine, fine, fine), BadParameter);
  EXPECT_EQ(pair.simulation.world().joints().size(), joints_before);
  const auto message = messageOf<BadParameter>([&] { a->attachHinge(b, o, z, 10, -10); });
  EXPECT_TRUE(contains(message, "10 .. -10 deg"));
}

TEST(Joint, APrimitiveCannotBeAttachedToItselfOrToAnotherSimulation) {
  Pair pair, other;
  const Vector o = Vector::Zero(), x = Vector::UnitX(), z = Vector::UnitZ();
  for (Primitive* wrong : {pair.body, other.body}) {
    EXPECT_THROW(pair.body->attachBall(wrong, o), BadParameter);
    EXPECT_THROW(pair.body->attachHinge(wrong, o, z), BadParameter);
    EXPECT_THROW(pair.body->attachHinge(wrong, o, x, z), BadParameter);
    EXPECT_THROW(pair.body->attachUniversal(wrong, o, x, z), BadParameter);
    EXPECT_THROW(pair.body->attachSlider(wrong, z), BadParameter);
  }
}

/// Reports of others: hinge limits near 180 degrees in ODE let bodies through or explode.
TEST(Joint, LimitsThatTheEngineCannotHoldAreRefused) {
  Pair pair;
  Primitive* bar = pair.body;
  const Vector o = Vector::Zero(), x = Vector::UnitX(), z = Vector::UnitZ();
  for (const Limits& wrong : {Limits{-200, 45}, Limits{0, 270}, Limits{-150, 180}, Limits{-180, 170}, Limits{-720, 720}}) {
    EXPECT_THROW(bar->attachHinge(nullptr, o, z, wrong.low_deg, wrong.high_deg), BadParameter);
    EXPECT_THROW(bar->attachUniversal(nullptr, o, x, z, {-10, 10}, wrong), BadParameter);
  }
  EXPECT_THROW(bar->attachBall(nullptr, o, x, z, {-10, 10}, {-90, 90}, {-10, 10}), BadParameter) << "the middle Euler angle";
  const auto message = messageOf<BadParameter>([&] { bar->attachHinge(nullptr, o, z, -200, 45); });
  EXPECT_TRUE(contains(message, "-175 .. 175 deg")) << message;
}

TEST(Joint, LimitsWithoutThePoseAsBuiltAreRefused) {
  Pair pair;
  for (const Limits& wrong : {Limits{-175, -170}, Limits{10, 60}, Limits{30, 30}}) {
    const auto message =
        messageOf<BadParameter>([&] { pair.body->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), wrong.low_deg, wrong.high_deg); });
    EXPECT_TRUE(contains(message, "contain 0 deg")) << message;
  }
}

/// A bar on a hinge without gravity, 100 mm from its centre.
class Spinner : public Robot {
 public:
  explicit Spinner(World& world, double rad_per_s = 6, std::optional<Limits> limits = {}) : Robot(world) {
    Box& bar = addBox({.mass_g = 400, .center_mm = {100, 0, 0}, .size_mm = {200, 20, 20}});
    reportAngle("spinner", bar.hingeToWorld({.anchor_mm = Vector(0, 0, 0), .limits_deg = limits}));
    dBodySetAngularVel(bar.body().id, 0, 0, rad_per_s);
    dBodySetLinearVel(bar.body().id, 0, rad_per_s * 100, 0);
  }
};

TEST(Joint, AnglesCountOnBeyondHalfATurn) {
  for (const double rad_per_s : {6., -6., 50.}) {
    Simulation simulation(weightless());
    const Robot& robot = simulation.build([&](World& world) { return std::make_unique<Spinner>(world, rad_per_s); });
    simulation.advance(1.5);
    EXPECT_NEAR(robot.getState().angle_deg[0], 1.5 * rad_per_s * deg_per_rad, 1.0 * std::abs(rad_per_s));
  }
}

TEST(Joint, AFastBarIsStoppedNearTheFarthestLimit) {
  Simulation simulation(weightless());
  const Robot& robot = simulation.build([&](World& world) { return std::make_unique<Spinner>(world, 30, Limits{-170, 175}); });
  double highest_deg = 0, lowest_deg = 0;
  for (int i = 0; i < 200; ++i) {
    simulation.advance(0.01);
    const double angle_deg = robot.getState().angle_deg[0];
    highest_deg = std::max(highest_deg, angle_deg);
    lowest_deg = std::min(lowest_deg, angle_deg);
  }
  EXPECT_LT(highest_deg, 180);
  EXPECT_GT(highest_deg, 174);
  EXPECT_GT(lowest_deg, -180);
}

}  // namespace
}  // namespace musclesim
