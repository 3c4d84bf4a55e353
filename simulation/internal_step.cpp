#include "internal_step.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../robot/actuator_step.h"
#include "bone_mobility.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

namespace {

constexpr double line_margin_ratio =
    0.6;  ///< share of the stability limit in the pose as built; the lever arms of lines differ in other poses

using Pushes = std::vector<LineOfPull::Push>;

/// Largest eigenvalue of sqrt(k_a k_b) J_a P J_b^T over all line muscles: squared rate of the fastest vibration of springs k on the bones.
/// P is the mobility of the bones (BoneMobility).
double largestEigenvalue(const BoneMobility& mobility, const std::vector<Pushes>& lines, const std::vector<double>& k) {
  const auto count = static_cast<Eigen::Index>(lines.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      matrix(a, b) = std::sqrt(k[i] * k[j]) * mobility.between(lines[i], lines[j]);
    }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

std::vector<dBodyID> beadsOf(const std::vector<Actuator*>& actuators) {
  std::vector<dBodyID> beads;
  for (const auto& actuator : actuators)
    for (const Link& link : actuator->links()) beads.insert(beads.end(), std::begin(link.bead), std::end(link.bead));
  std::sort(beads.begin(), beads.end());
  return beads;
}

/// Longest stable step: h^2 K / 4 + h D / 2 = 1 for the largest rates K and D of the line muscles' stiffness and friction.
double longestLineStepS(const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                        const std::vector<Actuator*>& actuators) {
  std::vector<Pushes> lines;
  std::vector<double> stiffness, damping;
  const double speed_ratio = std::sqrt(physics.force_per_N / world_force_per_N);
  for (const auto& actuator : actuators) {
    if (!actuator->line()) continue;
    const double l = actuator->maximumLengthMm();
    const double steepest = std::max(actuator->forceLaw().stiffnessNPerMm(0, l), actuator->forceLaw().stiffnessNPerMm(1, l));
    lines.push_back(actuator->line()->pushes());
    stiffness.push_back(LineOfPull::stiffnessNPerMm(std::max(0.0, steepest)) * physics.force_per_N);
    damping.push_back(LineOfPull::dampingNsPerMm(actuator->settings()) * physics.force_per_N / speed_ratio);
  }
  if (lines.empty()) return std::numeric_limits<double>::infinity();
  const BoneMobility mobility(joints, beadsOf(actuators));
  const double k = largestEigenvalue(mobility, lines, stiffness), d = largestEigenvalue(mobility, lines, damping);
  return k > 0 ? (std::sqrt(d * d + 4 * k) - d) / k : std::numeric_limits<double>::infinity();
}

double longestChainStepS(const std::vector<Actuator*>& actuators) {
  double fastest = 0;
  for (const auto& actuator : actuators) fastest = std::max(fastest, fastestSwayRadPerS(*actuator));
  return fastest > 0 ? 2 / fastest : std::numeric_limits<double>::infinity();
}

void setParameter(const Joint& joint, int which, double value) {
  switch (joint.kind()) {
    case Joint::Kind::ball:
      return dJointSetBallParam(joint.id(), which, value);
    case Joint::Kind::hinge:
      return dJointSetHingeParam(joint.id(), which, value);
    case Joint::Kind::hinge2:
      return dJointSetHinge2Param(joint.id(), which, value);
    case Joint::Kind::universal:
      return dJointSetUniversalParam(joint.id(), which, value);
    case Joint::Kind::slider:
      return dJointSetSliderParam(joint.id(), which, value);
    case Joint::Kind::fixed:
      return dJointSetFixedParam(joint.id(), which, value);
  }
}

double parameterOf(const Joint& joint, int which) {
  switch (joint.kind()) {
    case Joint::Kind::ball:
      return dJointGetBallParam(joint.id(), which);
    case Joint::Kind::hinge:
      return dJointGetHingeParam(joint.id(), which);
    case Joint::Kind::hinge2:
      return dJointGetHinge2Param(joint.id(), which);
    case Joint::Kind::universal:
      return dJointGetUniversalParam(joint.id(), which);
    case Joint::Kind::slider:
      return dJointGetSliderParam(joint.id(), which);
    case Joint::Kind::fixed:
      return dJointGetFixedParam(joint.id(), which);
  }
  return 0;
}

/// Ball and fixed joints have one error reduction (ERP). Other joints have one per axis for its stops and use the world's ERP for their
/// positions.
void adaptErrorReduction(const Joint& joint, double before, double now) {
  const bool of_position = joint.kind() == Joint::Kind::ball || joint.kind() == Joint::Kind::fixed;
  const int first_axis = of_position ? dParamERP : dParamStopERP;
  const bool two_axes = joint.kind() == Joint::Kind::hinge2 || joint.kind() == Joint::Kind::universal;
  const int second_axis = dParamStopERP2;
  if (parameterOf(joint, first_axis) == before) setParameter(joint, first_axis, now);
  if (two_axes && parameterOf(joint, second_axis) == before) setParameter(joint, second_axis, now);
}

void setStop(const Joint& joint, const PhysicsSettings::Stop& stop) {
  setParameter(joint, dParamStopERP, stop.error_reduction);
  setParameter(joint, dParamStopCFM, stop.softness);
}

}  // namespace

int automaticSubsteps(double step_s, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                      const std::vector<Actuator*>& actuators) {
  if (!std::isfinite(physics.longest_internal_step_s)) return 1;
  const double longest_s = std::min({physics.longest_internal_step_s, physics.stability_margin_ratio * longestChainStepS(actuators),
                                     line_margin_ratio * longestLineStepS(physics, joints, actuators)});
  const double count = std::max(1.0, std::ceil(step_s / longest_s - 1e-9));
  constexpr double most = 1e6;  // as for --substeps
  if (!(longest_s > 0) || !(count <= most))
    throw BadParameter("internal steps per step", fmt::format("{}", count),
                       "be at most 1000000: the force of a muscle or an actuator grows too steeply with its length");
  return static_cast<int>(count);
}

void adaptJoints(double h_s, double before, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                 const std::vector<Actuator*>& actuators) {
  for (const auto& joint : joints) adaptErrorReduction(*joint, before, physics.errorReductionPerStep(h_s));
  for (const auto& actuator : actuators) {
    if (physics.slider_stop_compliance > 0)
      for (const Link& link : actuator->links())
        setStop(*link.slider, physics.stop(physics.slider_stop_compliance, physics.stop_time_constant_s, h_s));
    if (physics.hinge_stop_compliance > 0)
      for (const Joint* hinge : actuator->hinges())
        setStop(*hinge, physics.stop(physics.hinge_stop_compliance, physics.stop_time_constant_s, h_s));
  }
}

}  // namespace musclesim
