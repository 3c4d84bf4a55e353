/// Body stage: limit cases in closed form, on a pendulum without muscles and on the elbow.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "effect_runs.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"
#include "support/out_of_catalogue_laws.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double mass_kg = 0.5, length_m = 0.25;
constexpr double weight_N = mass_kg * gravity_m_per_s2;

/// A bob on a massless rod, hinged at the origin about z; positive angles move it to +x.
class Pendulum : public Robot {
 public:
  explicit Pendulum(World& world) : Robot(world) {
    auto* bob = new Sphere(world, nullptr, {0, -length_m * mm_per_m, 0}, mass_kg * g_per_kg, 0, 1);
    addAngle("top", bob->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), -120, 120));
    setHand(bob);
  }
};

/// Inertia of the bob about the hinge; the drawn sphere of 1 mm adds a little.
constexpr double inertia_kgm2 = mass_kg * length_m * length_m;

SimulationOptions optionsWith(std::vector<ActiveEffect> effects) {
  SimulationOptions options;
  options.effects = std::move(effects);
  return options;
}

class Swing {
 public:
  explicit Swing(std::vector<ActiveEffect> effects) : simulation_(optionsWith(std::move(effects))), robot_(simulation_.build<Pendulum>()) {
    simulation_.start("built", {});
  }
  double angleDeg() const { return robot_.truth().angle_deg[0]; }
  void run(double duration_s) { simulation_.advance(duration_s); }
  Simulation& simulation() { return simulation_; }
  /// Gives the bob a horizontal velocity.
  void push(double velocity_m_per_s) {
    dBodyID bob = robot_.hand()->body().id;
    dBodySetLinearVel(bob, velocity_m_per_s * mm_per_m, 0, 0);
    dBodySetAngularVel(bob, 0, 0, velocity_m_per_s / length_m);
  }
  /// Largest angles between changes of direction, in order, over a time.
  std::vector<double> amplitudesDeg(double duration_s) {
    std::vector<double> result;
    double before = angleDeg(), rate_before = 0;
    for (int i = 0; i < static_cast<int>(duration_s / 0.01); ++i) {
      run(0.01);
      const double rate = angleDeg() - before;
      if (rate * rate_before < 0) result.push_back(std::abs(before));
      rate_before = rate;
      before = angleDeg();
    }
    return result;
  }

 private:
  Simulation simulation_;
  Robot& robot_;
};

const ActiveEffect oil = {"joint_viscous_friction", "all", {{"damping_Nms_per_rad", 0.3}}};

/// Rest position of the pendulum, with viscous damping.
double restDeg(std::vector<ActiveEffect> effects) {
  effects.push_back(oil);
  Swing swing(std::move(effects));
  swing.run(6);
  return swing.angleDeg();
}

TEST(ExternalForce, TurnsThePendulum) {
  EXPECT_NEAR(restDeg({{"external_force", "hand", {{"force_x_N", 2.0}}}}), std::atan2(2, weight_N) * deg_per_rad, 1e-3);
  EXPECT_NEAR(restDeg({{"external_force", "hand", {{"force_x_N", 2.0}, {"force_y_N", 1.0}}}}), std::atan2(2, weight_N - 1) * deg_per_rad,
              1e-3);
}

TEST(Payload, AddsItsWeight) {
  const ActiveEffect side = {"external_force", "hand", {{"force_x_N", 2.0}}};
  for (const double kg : {0.3, -0.2})
    EXPECT_NEAR(restDeg({side, {"payload", "hand", {{"mass_kg", kg}}}}), std::atan2(2, weight_N + kg * gravity_m_per_s2) * deg_per_rad,
                1e-3);
}

TEST(Payload, AddsItsInertia) {
  // Both get the same momentum; without gravity the first amplitude follows from the energy.
  SimulationOptions options = optionsWith({{"payload", "hand", {{"mass_kg", 0.7}}}});
  Simulation simulation(options);
  const Robot& robot = simulation.build("elbow");
  dMass mass;
  dBodyGetMass(robot.hand()->body().id, &mass);
  EXPECT_NEAR(mass.mass, 1300, 1e-9);
  const Vector center = robot.hand()->getPosition();
  EXPECT_NEAR(center.y(), -(0.6 * 120 + 0.7 * 250) / 1.3, 1e-9);
  // Inertia about the hinge (z): the forearm's own plus the point mass's.
  const double about_hinge =
      (robot.hand()->getRotation() * Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(mass.I).leftCols<3>() *
       robot.hand()->getRotation().transpose())(2, 2) +
      mass.mass * center.squaredNorm();
  EXPECT_NEAR(about_hinge / g_mm2_per_kg_m2, 0.0125 + 0.7 * 0.25 * 0.25, 1e-9);
  EXPECT_NEAR(robot.handMm().y(), -250, 1e-9);
}

TEST(Payload, MayNotTakeMoreThanThereIs) {
  EXPECT_THROW(Swing({{"payload", "hand", {{"mass_kg", -0.6}}}}), BadParameter);
  EXPECT_TRUE(contains(messageOf<BadParameter>([] {
                         Simulation(optionsWith({{"payload", "hand", {{"mass_kg", -0.5}}}})).build("elbow");
                       }),
                       "positive"));
}

TEST(Payload, HangsOnTheRigsLoad) {
  const Recording commands = commandsFor("rig", 0.1, [](double) { return Action{0.5}; });
  const ReplayResult light = replayWith(commands, {}), heavy = replayWith(commands, {{"payload", "hand", {{"mass_kg", 1.0}}}});
  ReplayOptions options;
  options.parameters.set("rig.load_kg", 3.0, "test");
  expectSame(replayWith(commands, {}, options).simulated, heavy.simulated);
  EXPECT_GT(valuesOf(heavy, "length_0_mm").front(), valuesOf(light, "length_0_mm").front() + 10);
}

TEST(BaseTilt, TurnsThePendulum) {
  EXPECT_NEAR(restDeg({{"base_tilt", "base", {{"tilt_z_deg", 5.0}}}}), 5, 1e-3);
  EXPECT_NEAR(restDeg({{"base_tilt", "base", {{"tilt_x_deg", 5.0}}}}), 0, 5e-3);
}

TEST(JointStiffness, PullsToItsRestAngle) {
  // k (q0 - q) = m g l sin q
  const double q = restDeg({{"joint_stiffness", "joint_top", {{"stiffness_Nm_per_rad", 1.5}, {"rest_deg", 20.0}}}}) * rad_per_deg;
  EXPECT_GT(q, 0.1);
  EXPECT_NEAR(1.5 * (20 * rad_per_deg - q), weight_N * length_m * std::sin(q), 1e-4);
}

TEST(JointStopOffset, MovesTheStops) {
  EXPECT_NEAR(restDeg({{"joint_stop_offset", "all", {{"offset_deg", -90.0}}}, {"external_force", "hand", {{"force_x_N", 5.0}}}}), 30, 0.2);
  EXPECT_NEAR(restDeg({{"external_force", "hand", {{"force_x_N", 5.0}}}}), std::atan2(5, weight_N) * deg_per_rad, 1e-3);
}

TEST(JointStopOffset, LetsTheStopsGiveWay) {
  // The stop of 120 - 90 = 30 deg: ((q - 30) / g)^1.5 + m g l sin q = F l cos q
  constexpr double push_N = 30, give_deg = 4;
  const double q = restDeg(
      {{"joint_stop_offset", "all", {{"offset_deg", -90.0}, {"give_deg", give_deg}}}, {"external_force", "hand", {{"force_x_N", push_N}}}});
  EXPECT_GT(q, 33);
  EXPECT_NEAR(std::pow((q - 30) / give_deg, 1.5) + weight_N * length_m * std::sin(q * rad_per_deg),
              push_N * length_m * std::cos(q * rad_per_deg), 1e-3);
}

TEST(Contact, HoldsThePendulumAtAJointOrAtTheHand) {
  // k (q - q_w) + m g l sin q = F l cos q
  const ActiveEffect side = {"external_force", "hand", {{"force_x_N", 3.0}}};
  const double q = restDeg({side, {"contact", "joint_top", {{"plane_deg", 10.0}, {"stiffness_Nm_per_deg", 0.5}}}});
  EXPECT_GT(q, 10);
  EXPECT_NEAR(0.5 * (q - 10) + weight_N * length_m * std::sin(q * rad_per_deg), 3 * length_m * std::cos(q * rad_per_deg), 1e-4);
  // F - k (x - x_w) = m g tan q
  const double at_hand =
      restDeg({side, {"contact", "hand", {{"plane_mm", 40.0}, {"axis", "x"}, {"stiffness_N_per_mm", 0.5}}}}) * rad_per_deg;
  const double depth_mm = length_m * mm_per_m * std::sin(at_hand) - 40;
  EXPECT_GT(depth_mm, 0);
  EXPECT_NEAR(3 - 0.5 * depth_mm, weight_N * std::tan(at_hand), 1e-3);
  // There is no wall on the other side of the plane.
  EXPECT_NEAR(
      restDeg(
          {side,
           {"contact", "joint_top", {{"plane_deg", 10.0}, {"side", "below"}, {"stiffness_Nm_per_deg", 0.0}, {"stiffness_N_per_mm", 0.0}}}}),
      std::atan2(3, weight_N) * deg_per_rad, 1e-3);
  EXPECT_THROW(restDeg({{"contact", "joint_top", {{"stiffness_N_per_mm", 0.5}}}}), BadParameter);
}

TEST(JointViscousFriction, DampsInProportionToSpeed) {
  // Amplitudes of a damped oscillator fall by exp(-b/(2 I) T/2) from one side to the other.
  const double b = 0.01,
               ratio_expected = std::exp(-b / (2 * inertia_kgm2) * std::numbers::pi / std::sqrt(weight_N * length_m / inertia_kgm2));
  Swing swing({{"joint_viscous_friction", "all", {{"damping_Nms_per_rad", b}}}});
  swing.push(0.2);
  const std::vector<double> amplitudes = swing.amplitudesDeg(4);
  ASSERT_GT(amplitudes.size(), 4u);
  for (std::size_t i = 1; i < amplitudes.size(); ++i) EXPECT_NEAR(amplitudes[i] / amplitudes[i - 1], ratio_expected, 0.01);
}

TEST(JointCoulombFriction, TakesTheSameFromEverySwing) {
  // Small swings lose 2 tau_c / (m g l) from one side to the other, at any amplitude, and then stick.
  const double torque_Nm = 0.02, loss_deg = 2 * torque_Nm / (weight_N * length_m) * deg_per_rad;
  Swing swing({{"joint_coulomb_friction", "all", {{"torque_Nm", torque_Nm}}}});
  swing.push(0.3);
  const std::vector<double> amplitudes = swing.amplitudesDeg(3);
  ASSERT_GT(amplitudes.size(), 3u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(amplitudes[i - 1] - amplitudes[i], loss_deg, 0.05 * loss_deg);
  swing.run(5);
  const double stuck_deg = swing.angleDeg();
  swing.run(2);
  EXPECT_NEAR(swing.angleDeg(), stuck_deg, 2 * 1e-6 * deg_per_rad);  // it creeps at 1e-6 rad/s at most
}

TEST(JointCoulombFriction, HoldsUpToItsTorque) {
  for (const double share : {0.95, 1.05}) {
    Swing swing(
        {{"joint_coulomb_friction", "all", {{"torque_Nm", 0.2}}}, {"external_force", "hand", {{"force_x_N", share * 0.2 / length_m}}}});
    swing.run(0.5);
    EXPECT_EQ(std::abs(swing.angleDeg()) > 1e-3, share > 1) << share;
  }
}

TEST(JointCoulombFriction, GivesWayLikeASpringBeforeItSlides) {
  // tau_c q / d + m g l sin q = F l cos q
  const double torque_Nm = 0.4, presliding_deg = 5, side_N = 0.2;
  const std::vector<ActiveEffect> effects = {
      {"joint_coulomb_friction", "all", {{"torque_Nm", torque_Nm}, {"presliding_deg", presliding_deg}}},
      {"joint_viscous_friction", "all", {{"damping_Nms_per_rad", 0.5}}},
      {"external_force", "hand", {{"force_x_N", side_N}}}};
  const double q = restDeg({effects[2]}) * rad_per_deg, with_friction = [&] {
    Swing swing(effects);
    swing.run(20);
    return swing.angleDeg();
  }() * rad_per_deg;
  EXPECT_GT(with_friction, 0);
  EXPECT_LT(with_friction, 0.9 * q);
  EXPECT_NEAR(torque_Nm * with_friction / (presliding_deg * rad_per_deg) + weight_N * length_m * std::sin(with_friction),
              side_N * length_m * std::cos(with_friction), 1e-3);
}

TEST(JointCoulombFriction, TakesNoMoreThanItsTorqueOnceItSlides) {
  const double torque_Nm = 0.02, loss_deg = 2 * torque_Nm / (weight_N * length_m) * deg_per_rad;
  Swing swing({{"joint_coulomb_friction", "all", {{"torque_Nm", torque_Nm}, {"presliding_deg", 0.05}}}});
  swing.push(0.3);
  const std::vector<double> amplitudes = swing.amplitudesDeg(3);
  ASSERT_GT(amplitudes.size(), 3u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(amplitudes[i - 1] - amplitudes[i], loss_deg, 0.07 * loss_deg);
}

/// A ball on a horizontal guide along x.
class Carriage : public Robot {
 public:
  explicit Carriage(World& world) : Robot(world) {
    auto* ball = new Sphere(world, nullptr, Vector::Zero(), mass_kg * g_per_kg, 0, 1);
    addSlide("rail", ball->attachSlider(nullptr, Vector::UnitX()));
    setHand(ball);
  }
};

class Slid {
 public:
  explicit Slid(std::vector<ActiveEffect> effects) : simulation_(optionsWith(std::move(effects))), robot_(simulation_.build<Carriage>()) {
    simulation_.start("built", {});
  }
  double positionMm() const { return robot_.handMm().x(); }
  void run(double duration_s) { simulation_.advance(duration_s); }
  void push(double velocity_mm_per_s) { dBodySetLinearVel(robot_.hand()->body().id, velocity_mm_per_s, 0, 0); }

 private:
  Simulation simulation_;
  Carriage& robot_;
};

TEST(SlideFriction, StopsAMovingLoadAndHoldsIt) {
  // s = m v^2 / (2 F_c); the spring of 0.05 mm before it slides changes the way by no more than that.
  const double force_N = 0.8, velocity_mm_per_s = 200;
  const double way_mm = mass_kg * velocity_mm_per_s * velocity_mm_per_s / (2 * force_N * mm_per_m);
  for (const double presliding_mm : {0.0, 0.05}) {
    Slid load({{"slide_friction", "all", {{"force_N", force_N}, {"presliding_mm", presliding_mm}}}});
    load.push(velocity_mm_per_s);
    load.run(1);
    EXPECT_NEAR(load.positionMm(), way_mm, 0.02 * way_mm) << presliding_mm;
    const double stuck_mm = load.positionMm();
    load.run(1);
    EXPECT_NEAR(load.positionMm(), stuck_mm, 2 * presliding_mm + 1e-5) << presliding_mm;
  }
}

TEST(SlideFriction, HoldsUpToItsForce) {
  for (const double share : {0.95, 1.05}) {
    Slid load({{"slide_friction", "slide_rail", {{"force_N", 2.0}}}, {"external_force", "hand", {{"force_x_N", share * 2}}}});
    load.run(0.5);
    EXPECT_EQ(std::abs(load.positionMm()) > 0.1, share > 1) << share;
  }
}

TEST(DissipativeBodies, NeverAddEnergy) {
  const std::vector<ActiveEffect> kinds = {{"joint_coulomb_friction", "all", {{"torque_Nm", 0.05}}},
                                           {"joint_viscous_friction", "all", {{"damping_Nms_per_rad", 0.5}}},
                                           {"joint_viscous_friction", "all", {{"damping_Nms_per_rad", 0.01}}}};
  for (const ActiveEffect& kind : kinds) {
    Swing swing({kind}), clean({});
    swing.push(1.0);
    clean.push(1.0);
    double before_J = swing.simulation().mechanicalEnergyJ(), clean_before_J = before_J;
    for (int i = 0; i < 200; ++i) {
      swing.run(0.01);
      clean.run(0.01);
      const double now_J = swing.simulation().mechanicalEnergyJ(), clean_now_J = clean.simulation().mechanicalEnergyJ();
      // The integrator alone makes the energy of a free swing vary by this much.
      EXPECT_LE(now_J, before_J + 2e-4) << kind.id << " at " << i;
      before_J = now_J;
      clean_before_J = clean_now_J;
    }
    EXPECT_LT(before_J, clean_before_J - 0.02);
  }
}

TEST(AttachmentOffset, MovesTheStartOfTheMuscle) {
  // Elbow at 0 deg: the muscle runs from (35 + d, 240) to (35, -20).
  Simulation simulation(optionsWith({{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}}}}));
  Robot& robot = simulation.build("elbow");
  EXPECT_NEAR(robot.truth().length_mm[0], std::hypot(260, 8), 1e-6);
  EXPECT_NEAR(robot.truth().length_mm[1], 260, 1e-6);
  Simulation other(optionsWith({{"attachment_offset", "muscle_1", {{"offset_mm", 8.0}}}}));
  EXPECT_NEAR(other.build("elbow").truth().length_mm[1], std::hypot(260, 8), 1e-6);
}

TEST(AttachmentOffset, MayRise) {
  // The muscle runs from (35 + 8, 240 + 2) to (35, -20), or from (35, 240 + 2).
  Simulation simulation(optionsWith({{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}, {"rise_mm", 2.0}}}}));
  EXPECT_NEAR(simulation.build("elbow").truth().length_mm[0], std::hypot(262, 8), 1e-6);
  Simulation straight(optionsWith({{"attachment_offset", "muscle_0", {{"rise_mm", 2.0}}}}));
  EXPECT_NEAR(straight.build("elbow").truth().length_mm[0], 262, 1e-6);
}

TEST(AttachmentOffset, MovesTheEndOfTheMuscleWithTheForearm) {
  // Elbow at 0 deg: from (35, 240) to (35 + 8, -20 + 2); the lever arm about the hinge grows by the same amount at every angle of the
  // forearm.
  Simulation simulation(
      optionsWith({{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}, {"rise_mm", 2.0}, {"attachment", std::string("end")}}}}));
  Robot& robot = simulation.build("elbow");
  EXPECT_NEAR(robot.truth().length_mm[0], std::hypot(258, 8), 1e-6);
  EXPECT_NEAR(robot.truth().length_mm[1], 260, 1e-6);
  simulation.settle({0.6, 0.4});
  const double angle_rad = robot.truth().angle_deg[0] * rad_per_deg;
  EXPECT_GT(angle_rad, 0.1);
  const Vector end = Eigen::AngleAxisd(angle_rad, Vector::UnitZ()) * Vector(43, -18, 0);
  EXPECT_NEAR(robot.truth().length_mm[0], (Vector(35, 240, 0) - end).norm(), 1e-3);
}

TEST(AttachmentOffset, OfTheWristsLeverTurnsWithTheHand) {
  Simulation clean(optionsWith({}));
  const double clean_mm = clean.build("wrist").truth().length_mm[0];
  Simulation simulation(optionsWith({{"attachment_offset", "muscle_0", {{"rise_mm", 2.0}, {"attachment", std::string("end")}}}}));
  EXPECT_NEAR(simulation.build("wrist").truth().length_mm[0], clean_mm - 2, 0.1);
}

TEST(AttachmentOffset, OfTheEndIsRefusedWhereTheStartDoesTheSame) {
  for (const char* robot : {"rig", "spring_bench"})
    EXPECT_THROW(
        Simulation(optionsWith({{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}, {"attachment", std::string("end")}}}})).build(robot),
        BadParameter)
        << robot;
}

TEST(AttachmentOffset, OfTheForeignLawIsTurnedToTheVertical) {
  // The muscle runs from (35 + 8 cos, 240 + 8 sin) to (35, -20).
  Simulation simulation(optionsWith({{"foreign.turned_attachment", "muscle_0", {{"offset_mm", 8.0}, {"turn_deg", 25.0}}}}));
  const double turn_rad = 25 * rad_per_deg;
  EXPECT_NEAR(simulation.build("elbow").truth().length_mm[0], std::hypot(260 + 8 * std::sin(turn_rad), 8 * std::cos(turn_rad)), 1e-6);
}

TEST(AttachmentOffset, OfARigLeavesItsLoadAtRest) {
  const Recording commands = commandsFor("rig", 0.5, [](double) { return Action{0.4}; });
  for (const char* id : {"attachment_offset", "foreign.turned_attachment"}) {
    const auto length_mm = valuesOf(replayWith(commands, {{id, "muscle_0", {{"offset_mm", 20.0}}}}), "length_0_mm");
    for (const double value : length_mm) EXPECT_NEAR(value, length_mm.front(), 0.2) << id;
  }
}

TEST(AttachmentOffset, IsRefusedByRobotsThatDoNotAskForIt) {
  class Plain : public Robot {
   public:
    explicit Plain(World& world) : Robot(world) {
      auto* muscle = new Muscle(world, space(), {0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -210, 0}, 120, 300);
      muscle->connectStartTo(nullptr);
      addActuator(muscle);
    }
  };
  EXPECT_THROW(Simulation(optionsWith({{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}}}})).build<Plain>(), BadParameter);
}

TEST(Settling, EquilibriumIncludesTheEffects) {
  // A run that begins settled stays at rest, except for the chains' friction.
  const std::vector<std::vector<ActiveEffect>> lists = {
      {{"payload", "hand", {{"mass_kg", 0.3}}}},
      {{"base_tilt", "base", {{"tilt_z_deg", 6.0}}}},
      {{"external_force", "hand", {{"force_x_N", 3.0}}}},
      {{"joint_stiffness", "all", {{"stiffness_Nm_per_rad", 2.0}, {"rest_deg", 20.0}}}},
      {{"force_gain", "muscle_0", {{"gain", 0.7}}}},
      {{"series_elasticity", "all", {{"stiffness_N_per_mm", 3.0}}}},
      {{"creep", "all", {{"amount", 0.2}, {"time_constant_s", 0.5}}}},
      {{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}}}},
      {{"attachment_offset", "muscle_0", {{"offset_mm", 8.0}, {"attachment", std::string("end")}}}},
      {{"leak", "all", {{"leak_per_s", 3.0}}}},
      {{"contact", "joint_elbow", {{"plane_deg", -3.0}, {"side", "below"}, {"stiffness_Nm_per_deg", 2.0}}}}};
  const Recording commands = commandsFor("elbow", 0.5, [](double) { return Action{0.45, 0.5}; });
  const double clean_deg = valuesOf(replayWith(commands, {}), "angle_elbow_deg").front();
  for (const auto& effects : lists) {
    const ReplayResult run = replayWith(commands, effects);
    const auto& angle = valuesOf(run, "angle_elbow_deg");
    EXPECT_NEAR(angle.back(), angle.front(), 0.05) << effects.front().id;
    EXPECT_GT(std::abs(angle.front() - clean_deg), 0.05) << effects.front().id;
  }
}

}  // namespace
}  // namespace musclesim
