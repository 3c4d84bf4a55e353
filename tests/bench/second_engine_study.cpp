/// Robots in musclesim and in MuJoCo: passive falls, equilibria, energy and reversed time; and closed forms where there are any.
/// Prints a table and ends with 1 if a number is out of bounds, with 77 (not tried) where MuJoCo is missing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "../peers/peers_fixture.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "peers/own.h"

using namespace musclesim;
using namespace musclesim::peers;

#ifdef MUSCLESIM_HAS_MUJOCO
extern "C" const PeerEngine* musclesim_peer_mujoco();
#else
static const PeerEngine* musclesim_peer_mujoco() {
  return nullptr;
}
#endif

namespace {

constexpr double control_step_s = 0.01;
constexpr int substeps = 100;
constexpr int fall_steps = 50;  ///< 0.5 s
constexpr int rest_steps = 20;  ///< 0.2 s
const std::vector<std::string> hard = {"physics.constraint_force_mixing=1e-14"};
const std::vector<std::string> frictionless = {"muscle.slider_friction_N=0"};

struct StudyRobot {
  std::string name, source;  ///< a robot's name or the text of a file
  std::vector<std::string> parameters;
  bool conserves;                       ///< no muscles and no friction: energy stays, and time can be reversed
  double fall_bound_mm, rest_bound_mm;  ///< the latter is 0 where there is nothing to settle, or no way to do it
  bool settles = rest_bound_mm > 0;
};

std::string rod(const std::string& name, const std::string& at, const std::string& joint) {
  return fmt::format(
      "[[body]]\nname = \"{0}\"\nat_mm = {1}\nshape = {{ type = \"capsule\", radius_mm = 10, length_mm = 160 }}\nmass_g = 500\n\n"
      "[[joint]]\nbody = \"{0}\"\n{2}\n\n",
      name, at, joint);
}

/// The hand is near the end of the rod.
std::string file(const std::string& parts, const std::string& hand) {
  return "format = \"musclesim-robot-1\"\nname = \"sample\"\n\n" + parts + "[hand]\nbody = \"" + hand +
         (hand == "upper" ? "\"\nat_mm = [0, 0, 180]\n" : "\"\nat_mm = [0, 0, 380]\n");
}

std::vector<StudyRobot> robots() {
  const std::string hinge = "name = \"hinge\"\ntype = \"hinge\"\nat_mm = [0, 0, 0]\naxis = \"x\"";
  const std::string first = rod("upper", "[0, 0, 100]", hinge);
  const auto second = [&](const std::string& joint) {
    return rod("lower", "[0, 0, 300]", "to = \"upper\"\nat_mm = [0, 0, 200]\n" + joint);
  };
  return {
      {"pendulum", file(first, "upper"), hard, true, 0.2, 0},
      {"damped pendulum", file(rod("upper", "[0, 0, 100]", hinge + "\ndamping_Nms_per_rad = 0.01"), "upper"), hard, false, 0.2, 0},
      {"pendulum with dry friction", file(rod("upper", "[0, 0, 100]", hinge + "\nfriction_Nm = 0.1"), "upper"), hard, false, 1, 0},
      {"pendulum on a ball", file(rod("upper", "[30, 0, 100]", "name = \"ball\"\ntype = \"ball\"\nat_mm = [0, 0, 0]"), "upper"), hard, true,
       5, 0},
      {"double pendulum", file(first + second("name = \"second\"\ntype = \"hinge\"\naxis = \"x\""), "lower"), hard, true, 1, 0},
      {"skew double pendulum", file(first + second("name = \"second\"\ntype = \"hinge\"\naxis = \"y\""), "lower"), hard, true, 1, 0},
      {"pendulum on a carriage",
       file(rod("upper", "[0, 0, 100]", "name = \"rail\"\ntype = \"slider\"\naxis = \"z\"") +
                second("name = \"second\"\ntype = \"hinge\"\naxis = \"x\""),
            "lower"),
       hard, true, 1, 0},
      {"pendulum with a universal joint",
       file(first + rod("lower", "[40, 0, 300]",
                        "to = \"upper\"\nat_mm = [0, 0, 200]\nname = \"second\"\ntype = \"universal\"\naxis = \"x\"\naxis2 = \"y\""),
            "lower"),
       hard, true, 5, 0},
      {"rig, line", "rig", {"muscle.model=line"}, false, 0.5, 0.05},
      {"rig, chain", "rig", {}, false, 12, 1},
      {"rig, chain, viscous friction", "rig", {"muscle.joint_friction=viscous"}, false, 12, 1},
      {"elbow, lines", "elbow", {"muscle.model=line"}, false, 1, 0.05},
      {"elbow, chains", "elbow", {}, false, 1, 1},
      {"wrist, lines", "wrist", {"muscle.model=line"}, false, 1, 0.05},
      {"pulley_arm", "pulley_arm", {}, false, 1, 0.05},
      {"arm, 10 lines", "arm", {"muscle.model=line", "arm.muscle_count=10"}, false, 5, 0},
  };
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::unique_ptr<Peer> inMujoco(const Sample& sample) {
  return musclesim_peer_mujoco()->make(sample.mechanism, sample.tree, {"RK4, Newton, hard stops", control_step_s / substeps});
}

double handDifferenceMm(Sample& sample, const Peer& theirs) {
  return (theirs.handM() * mm_per_m - sample.simulation.robot().handMm()).norm();
}

struct Fall {
  double difference_mm = 0, way_mm = 0;
};

/// Unequal pressures, so that no pair of muscles holds a joint in the middle.
Action heldPressures(const Sample& sample) {
  Action command(sample.mechanism.muscles.size());
  for (std::size_t i = 0; i < command.size(); ++i) command[i] = i % 2 == 0 ? 0.6 : 0.3;
  return command;
}

/// Puts the robot at rest under pressures and reads it there.
void settle(Sample& sample) {
  sample.simulation.settle(heldPressures(sample));
  sample.read();
}

/// Lets the robot fall without pressure in both engines. It begins where pressures held it at rest; a robot without muscles, or one that
/// cannot settle, begins in the pose as built.
Fall fall(const StudyRobot& robot) {
  Sample sample(robot.source, joined(robot.parameters, hard), substeps);
  if (robot.settles) settle(sample);
  const auto theirs = inMujoco(sample);
  const Action none(sample.mechanism.muscles.size(), 0.0);
  const Vector start_mm = sample.simulation.robot().handMm();
  Fall result;
  for (int i = 0; i < fall_steps; ++i) {
    sample.simulation.robot().step(none);
    sample.simulation.step();
    theirs->advance(none, substeps);
    result.difference_mm = std::max(result.difference_mm, handDifferenceMm(sample, *theirs));
    result.way_mm = std::max(result.way_mm, (sample.simulation.robot().handMm() - start_mm).norm());
  }
  return result;
}

/// How far the hand leaves the equilibrium that musclesim finds, in MuJoCo: lines without friction. Chains keep theirs: without it the
/// weight of the beads draws the upper links long and the lower ones short.
double driftMm(const StudyRobot& robot) {
  const bool line = std::ranges::count(robot.parameters, "muscle.model=line") > 0 || robot.name == "pulley_arm";
  Sample sample(robot.source, joined(joined(robot.parameters, hard), line ? frictionless : std::vector<std::string>()), substeps);
  settle(sample);
  const auto theirs = inMujoco(sample);
  double worst_mm = 0;
  for (int i = 0; i < rest_steps; ++i) {
    theirs->advance(heldPressures(sample), substeps);
    worst_mm = std::max(worst_mm, handDifferenceMm(sample, *theirs));
  }
  return worst_mm;
}

/// Change of energy over the largest kinetic energy in a fall, here and there.
struct Drift {
  double ours, theirs;
};

Drift energyDrift(const StudyRobot& robot) {
  Sample sample(robot.source, robot.parameters, substeps);
  const auto there = inMujoco(sample);
  const double ours_J = sample.simulation.mechanicalEnergyJ(), theirs_J = there->energyJ(),
               height_mm = sample.simulation.robot().handMm().y();
  double least_mm = height_mm, ours = 0, theirs = 0, weight_N = 0;
  for (const RigidBody& body : sample.mechanism.bodies) weight_N += body.mass_kg * sample.mechanism.gravity_m_per_s2;
  for (int i = 0; i < 4 * fall_steps; ++i) {
    sample.simulation.step();
    there->advance({}, substeps);
    least_mm = std::min(least_mm, sample.simulation.robot().handMm().y());
    ours = std::max(ours, std::abs(sample.simulation.mechanicalEnergyJ() - ours_J));
    theirs = std::max(theirs, std::abs(there->energyJ() - theirs_J));
  }
  const double scale_J = weight_N * (height_mm - least_mm) / mm_per_m;
  return {ours / scale_J, theirs / scale_J};
}

/// Falls, turns all velocities round, and falls back: distance of the hand from where it began.
double returnMm(const StudyRobot& robot) {
  Sample sample(robot.source, robot.parameters, substeps);
  const Vector start_mm = sample.simulation.robot().handMm();
  for (int i = 0; i < fall_steps; ++i) sample.simulation.step();
  for (const auto& body : sample.simulation.world().bodies()) {
    const dReal *v = dBodyGetLinearVel(body->id), *w = dBodyGetAngularVel(body->id);
    dBodySetLinearVel(body->id, -v[0], -v[1], -v[2]);
    dBodySetAngularVel(body->id, -w[0], -w[1], -w[2]);
  }
  for (int i = 0; i < fall_steps; ++i) sample.simulation.step();
  return (sample.simulation.robot().handMm() - start_mm).norm();
}

/// Bounds of energy and reversal: both methods are of first order here.
constexpr double energy_bound = 5e-3, return_bound_mm = 3;

std::string cell(double value, bool good) {
  return fmt::format("{:.2g}{}", value, good ? "" : " (too much)");
}

/// A row of the table. Sets `good` to false if a number is out of bounds.
std::string rowOf(const StudyRobot& robot, bool& good) {
  const auto checked = [&good](double value, double bound) {
    good = good && value <= bound;
    return cell(value, value <= bound);
  };
  const Fall f = fall(robot);
  std::string row = fmt::format("| {} | {} of {:.0f} |", robot.name, checked(f.difference_mm, robot.fall_bound_mm), f.way_mm);
  row += robot.rest_bound_mm > 0 ? fmt::format(" {} |", checked(driftMm(robot), robot.rest_bound_mm)) : " |";
  if (!robot.conserves) return row + " | |\n";
  const Drift drift = energyDrift(robot);
  return row +
         fmt::format(" {}, {:.1g} | {} |\n", checked(drift.ours, energy_bound), drift.theirs, checked(returnMm(robot), return_bound_mm));
}

/// The rig hangs where its muscle's law gives its weight.
double rigErrorMm() {
  Sample rig("rig", joined({"muscle.model=line"}, frictionless));
  rig.simulation.settle({0.5});
  const Actuator& muscle = *rig.simulation.robot().actuators().at(0);
  double low_mm = muscle.minimumLengthMm(), high_mm = muscle.maximumLengthMm();
  for (int i = 0; i < 60; ++i) {
    const double middle_mm = (low_mm + high_mm) / 2;
    (muscle.calculateForce(0.5, middle_mm) < 2 * gravity_m_per_s2 ? low_mm : high_mm) = middle_mm;
  }
  return std::abs(muscle.lengthMm() - low_mm);
}

/// Time of a pendulum from the horizontal to the vertical:  sqrt(I / (m g d)) K(1/2),  K the complete elliptic integral for k^2 = 1/2.
double quarterPeriodError() {
  Sample pendulum(robots().front().source, hard, 10, 0.001);
  const RigidBody& body = pendulum.mechanism.bodies.front();
  const double d_m = 0.1, moment = body.inertia_kg_m2(0, 0) + body.mass_kg * d_m * d_m;
  const double expected_s = std::sqrt(moment / (body.mass_kg * gravity_m_per_s2 * d_m)) * std::comp_ellint_1(std::numbers::sqrt2 / 2);
  double before_mm = pendulum.simulation.robot().handMm().z();
  while (true) {
    pendulum.simulation.step();
    const double now_mm = pendulum.simulation.robot().handMm().z();
    if (now_mm <= 0) return std::abs(pendulum.simulation.time_s() - 0.001 * now_mm / (now_mm - before_mm) - expected_s) / expected_s;
    before_mm = now_mm;
  }
}

}  // namespace

int main() {
  if (!musclesim_peer_mujoco()) {
    std::puts("not tried: built without libmujoco-dev");
    return 77;
  }
  bool good = true;
  fmt::print("musclesim (steps of 0.1 ms) and MuJoCo {} (RK4, 0.1 ms): hand, in mm\n\n", musclesim_peer_mujoco()->version);
  fmt::print(
      "| robot | fall of 0.5 s: difference of way | equilibrium of musclesim: drift in MuJoCo in 0.2 s | energy in 2 s: change over what "
      "falls, ours, "
      "theirs | 0.5 s forth and back: from the start |\n|---|---|---|---|---|\n");
  for (const StudyRobot& robot : robots()) {
    fmt::print("{}", rowOf(robot, good));
    std::fflush(stdout);
  }
  const double rig_mm = rigErrorMm(), period = quarterPeriodError();
  good = good && rig_mm < 1e-6 && period < 1e-3;
  fmt::print(
      "\nclosed forms: rig at rest {:.1g} mm off the law's length; quarter period of the pendulum {:.1g} off the elliptic integral's\n",
      rig_mm, period);
  return good ? 0 : 1;
}
