#include "resting_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/line_of_pull.h"
#include "musclesim/robot/primitive.h"

namespace musclesim {

namespace {

constexpr double first_stop_N_per_mm = 1000;  ///< much stiffer than a muscle (some N/mm), so that a few corrections suffice
constexpr double rounding_mm = 1e-6;          ///< of the length of a straight chain
constexpr double torque_lever_mm = 100;       ///< makes an amount of force of a torque

}  // namespace

RestingForces::RestingForces(World& world, Skeleton& skeleton)
    : world_(world),
      skeleton_(skeleton),
      gravity_(world.gravityMmPerS2() / world.physics().force_per_N),
      stop_N_per_mm_(first_stop_N_per_mm) {
  const std::vector<Actuator*>& actuators = world.actuators();
  for (std::size_t i = 0; i < actuators.size(); ++i)
    if (!actuators[i]->line() || actuators[i]->line()->isConnected()) pulls_.push_back(pullOf(*actuators[i], static_cast<int>(i)));
  for (int i = 0; i < skeleton.bodyCount(); ++i) {
    dMass mass;
    dBodyGetMass(skeleton.body(i).id, &mass);
    weight_N_ += mass.mass * gravity_.norm();
  }
}

RestingForces::Pull RestingForces::pullOf(Actuator& actuator, int number) const {
  const auto [shortest_mm, longest_mm] = actuator.straightLengthRange();
  Pull pull = {&actuator, number, {}, {}, actuator.massG() / 2 * gravity_, shortest_mm, longest_mm};
  if (actuator.line()) return pull;
  pull.start = endAt(actuator.startJoint(), actuator, "start");
  pull.end = endAt(actuator.endJoint(), actuator, "end");
  return pull;
}

RestingForces::End RestingForces::endAt(const Joint* joint, const Actuator& actuator, const std::string& which) const {
  if (!joint) throw BadParameter("the " + which + " of " + actuator.name() + " is not connected, so it does not hang straight");
  return {skeleton_.numberOf(dJointGetBody(joint->id(), 1)), joint->reference().anchor[1]};
}

void RestingForces::at(const Eigen::VectorXd& coordinates, Eigen::VectorXd& generalised) {
  skeleton_.setPose(coordinates);
  skeleton_.placeBodies();
  skeleton_.loadWithWeights(gravity_);
  addOtherLoads();
  for (Pull& pull : pulls_) pull.actuator->line() ? addLine(pull) : addChain(pull);
  skeleton_.takeForces(generalised);
}

void RestingForces::addOtherLoads() {
  load_N_ = 0;
  const auto add = [this](int body, const BodyLoad& load) {
    skeleton_.addLoad(body, load);
    load_N_ += load.force_N.norm() + load.torque_Nmm.norm() / torque_lever_mm;
  };
  for (int i = 0; i < skeleton_.bodyCount(); ++i)
    if (!skeleton_.body(i).parts.empty()) add(i, world_.effects().restingLoad(*skeleton_.body(i).parts.front()));
  for (const auto& element : world_.forceElements())
    element->load(true, [&](dBodyID body, const BodyLoad& load) { add(skeleton_.numberOf(body), load); });
}

double RestingForces::stopN(const Pull& pull) const {
  return std::max(0.0, pull.longest_stop_N + stop_N_per_mm_ * (pull.length_mm - pull.longest_mm)) -
         std::max(0.0, pull.shortest_stop_N + stop_N_per_mm_ * (pull.shortest_mm - pull.length_mm));
}

void RestingForces::addChain(Pull& pull) {
  const Vector start = skeleton_.pointMm(pull.start.body, pull.start.place), end = skeleton_.pointMm(pull.end.body, pull.end.place);
  const Vector along = end - start;
  pull.length_mm = along.norm();
  pull.tension_N = world_.effects().restingTensionN(pull.number, pull.length_mm);
  pull.stop_N = stopN(pull);
  Vector force = Vector::Zero();  // ends that coincide pull in no direction
  if (pull.length_mm > 0) force = (pull.tension_N + pull.stop_N) / pull.length_mm * along;
  skeleton_.addForce(pull.start.body, force + pull.half_weight_N, start);
  skeleton_.addForce(pull.end.body, pull.half_weight_N - force, end);
}

void RestingForces::addLine(Pull& pull) {
  pull.length_mm = pull.actuator->lengthMm();
  pull.tension_N = std::max(0.0, world_.effects().restingTensionN(pull.number, pull.length_mm));
  pull.stop_N = LineOfPull::stopN(pull.length_mm, pull.longest_mm);
  const double force_N = pull.tension_N + pull.stop_N;
  for (const LineOfPull::Push& push : pull.actuator->line()->pushes())
    skeleton_.addLoad(skeleton_.numberOf(push.body), {-force_N * push.force, -force_N * push.torque});
}

double RestingForces::typicalForceN() const {
  double sum_N = weight_N_ + load_N_;
  for (const Pull& pull : pulls_) sum_N += std::abs(pull.tension_N) + std::abs(pull.stop_N) + 2 * pull.half_weight_N.norm();
  return sum_N;
}

RestingForces::Beyond RestingForces::correctStops() {
  Beyond farthest;
  const auto correct = [&](const Actuator& muscle, double& stop_N, double beyond_mm) {
    const double corrected_N = std::max(0.0, stop_N + stop_N_per_mm_ * beyond_mm);
    const double change_mm = std::abs(corrected_N - stop_N) / stop_N_per_mm_;
    if (change_mm > farthest.by_mm) farthest = {&muscle, change_mm};
    stop_N = corrected_N;
  };
  for (Pull& pull : pulls_) {
    if (pull.actuator->line()) continue;
    correct(*pull.actuator, pull.longest_stop_N, pull.length_mm - pull.longest_mm);
    correct(*pull.actuator, pull.shortest_stop_N, pull.shortest_mm - pull.length_mm);
  }
  return farthest;
}

void RestingForces::requireChainsFit() const {
  for (const Pull& pull : pulls_)
    if (!pull.actuator->line() && pull.length_mm < pull.shortest_mm - rounding_mm)
      throw BadParameter(
          fmt::format("{} is a chain that runs in a curve and cannot be laid straight: in the pose as built its ends are "
                      "{:.4g} mm apart, and its links need {:.4g} mm",
                      pull.actuator->name(), pull.length_mm, pull.shortest_mm));
}

void RestingForces::layMuscles() const {
  for (const Pull& pull : pulls_)
    pull.actuator->placeStraight(skeleton_.pointMm(pull.start.body, pull.start.place), skeleton_.pointMm(pull.end.body, pull.end.place));
}

}  // namespace musclesim
