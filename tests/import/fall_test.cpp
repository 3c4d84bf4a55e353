/// The fall of a two-link arm from a URDF file against its equations of motion, integrated here.
#include "fall.h"

#include <Eigen/Dense>
#include <cmath>

#include "import_fixture.h"
#include "musclesim/base/file.h"
#include "musclesim/base/units.h"

namespace musclesim {
namespace {

/// Two links on hinges with parallel horizontal axes:
///     M(q) dv/dt + c(q, v) = -D v - friction,   friction of joint i = F_i sign(v_i), or what holds it at rest up to F_i
/// q_1 angle of the first link from its lowest position, q_2 of the second against the first; m masses in kg, l_1 length of the first link,
/// c distances of the centres of mass from the hinges in m, I moments about these in kg m^2.
struct TwoLinks {
  double m1, c1, i1, l1, m2, c2, i2;
  Eigen::Vector2d damping, friction;

  Eigen::Matrix2d mass(const Eigen::Vector2d& q) const {
    const double coupling = m2 * l1 * c2 * std::cos(q(1)), second = i2 + m2 * c2 * c2;
    Eigen::Matrix2d m;
    m << i1 + m1 * c1 * c1 + m2 * l1 * l1 + second + 2 * coupling, second + coupling, second + coupling, second;
    return m;
  }
  /// Gravity and centrifugal terms, -c(q, v).
  Eigen::Vector2d force(const Eigen::Vector2d& q, const Eigen::Vector2d& v) const {
    const double h = m2 * l1 * c2 * std::sin(q(1)), g = gravity_m_per_s2, second = m2 * c2 * g * std::sin(q(0) + q(1));
    return {h * v(1) * (2 * v(0) + v(1)) - (m1 * c1 + m2 * l1) * g * std::sin(q(0)) - second, -h * v(0) * v(0) - second};
  }
  /// One step of length h_s. The friction impulses p_i, |p_i| <= h F_i, stop a joint where they can.
  void step(Eigen::Vector2d& q, Eigen::Vector2d& v, double h_s) const {
    const Eigen::Matrix2d inverse = mass(q).inverse();
    const Eigen::Vector2d free = v + h_s * inverse * (force(q, v) - damping.cwiseProduct(v));
    Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
    for (int sweep = 0; sweep < 20; ++sweep)
      for (int i = 0; i < 2; ++i) {
        const double speed = free(i) + inverse.row(i).dot(impulse);
        impulse(i) = std::clamp(impulse(i) - speed / inverse(i, i), -h_s * friction(i), h_s * friction(i));
      }
    const Eigen::Vector2d next = free + inverse * impulse;
    q += h_s * (v + next) / 2;
    v = next;
  }
};

class FallTest : public ImportedRobotTest {};

TEST_F(FallTest, AnArmFromUrdfFollowsItsEquationsOfMotion) {
  const auto file = sharedFolder() / "data" / "robots" / "planar_arm.urdf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  // It hangs at rest as it is: lift it by a turn of the first joint's frame, and let the joints turn freely.
  constexpr double lift_rad = 1.3;
  std::string text = readTextFile(file.string(), 1 << 20);
  text = replaced(replaced(text, "rpy=\"0 0 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1.2\"",
                           "rpy=\"0 1.3 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1.2\""),
                  "revolute", "continuous");
  import(text);
  const TwoLinks arm{.m1 = 1.2,
                     .c1 = 0.15,
                     .i1 = 0.0095,
                     .l1 = 0.3,
                     .m2 = 0.7,
                     .c2 = 0.14,
                     .i2 = 0.00598,
                     .damping = {0.05, 0.03},
                     .friction = {0.1, 0.05}};
  Eigen::Vector2d q(lift_rad, 0), v(0, 0);
  const auto simulation = simulationOf(robot_);
  double worst_deg = 0, widest_deg = 0, time_s = 0;
  fall(*simulation, [&](double until_s, const std::vector<double>& angle_deg) {
    constexpr double h_s = 1e-5;
    for (; time_s < until_s - h_s / 2; time_s += h_s) arm.step(q, v, h_s);
    worst_deg =
        std::max({worst_deg, std::abs(angle_deg[0] - (q(0) - lift_rad) * deg_per_rad), std::abs(angle_deg[1] - q(1) * deg_per_rad)});
    widest_deg = std::max(widest_deg, std::abs(angle_deg[0]));
  });
  RecordProperty("worst_deg", std::to_string(worst_deg));
  EXPECT_LT(worst_deg, 0.1);
  EXPECT_GT(widest_deg, 60);  // it did fall
}

TEST_F(FallTest, ImportedRobotsRunWithTheUsualSettings) {
  for (const char* name : {"planar_arm.urdf", "arm26.xml", "pamy.xml"}) {
    const auto file = sharedFolder() / "data" / "robots" / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    importFile(file.string());
    Simulation simulation;
    Robot& robot = simulation.build([&](World& world) { return makeRobotFromText(robot_.toml, "imported.toml", world); });
    Action pressures(static_cast<std::size_t>(robot.actuatorCount()), 0.1);
    simulation.start("built", pressures);
    for (int step = 0; step < 50; ++step) {
      robot.step(pressures);
      simulation.step();
    }
    EXPECT_LT(simulation.worstGap().gap_mm, 1) << name << ": " << simulation.worstGap().joint;
  }
}

}  // namespace
}  // namespace musclesim
