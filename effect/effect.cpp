#include "musclesim/effect/effect.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "../robot/ode_vector.h"
#include "length_rate.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

std::string nameOf(Stage stage) {
  static const char* const names[] = {"command", "pressure", "force", "body", "sensor"};
  return names[static_cast<std::size_t>(stage)];
}

EffectValues::EffectValues(const std::vector<EffectParameter>& parameters, std::vector<double> values) : values_(std::move(values)) {
  for (const EffectParameter& parameter : parameters) names_.push_back(parameter.name);
  if (values_.size() != names_.size())
    throw std::logic_error("an effect has " + std::to_string(names_.size()) + " parameters, but " + std::to_string(values_.size()) +
                           " values were given");
}

double EffectValues::operator[](const std::string& name) const {
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (names_[i] == name) return values_[i];
  throw std::logic_error("there is no parameter " + name + " in the effect's list");
}

void MuscleRatioEffect::attach(const EffectPlace& place) {
  length_rate_ = place.length_rate;
  muscle_ = static_cast<std::size_t>(place.muscle);
  actuator_ = place.robot.actuators()[muscle_];
}

void MuscleRatioEffect::apply(std::vector<double>& ratios, const StepTime& time) {
  ratios[muscle_] = output(ratios[muscle_], time);
}

void MuscleRatioEffect::settle(std::vector<double>& ratios) {
  ratios[muscle_] = settled(ratios[muscle_]);
}

double MuscleRatioEffect::lengthRateMmPerS() const {
  return length_rate_->mmPerS();
}

void ForceEffect::attach(const EffectPlace& place) {
  world_ = &place.world;
  actuator_ = place.robot.actuators()[static_cast<std::size_t>(place.muscle)];
}

void JointEffect::attach(const EffectPlace& place) {
  for (const auto& angle : place.robot.angles())
    if (angle.name == place.joint) joint_ = angle.joint;
  if (!joint_ || joint_->kind() != Joint::Kind::hinge)
    throw BadParameter(fmt::format("effect on {}: it is not a hinge with one axis", place.component));
  force_per_N_ = place.world.physics().force_per_N;
}

double JointEffect::angleDeg() const {
  return joint_->angleDeg();
}

double JointEffect::rateRadPerS() const {
  return dJointGetHingeAngleRate(joint_->id());
}

void JointEffect::addTorqueNm(double torque_Nm) const {
  dJointAddHingeTorque(joint_->id(), torque_Nm * mm_per_m * force_per_N_);
}

void JointEffect::addDryFrictionNm(double torque_Nm) const {
  joint_->addDryFriction(torque_Nm * mm_per_m * force_per_N_);
}

void SlideEffect::attach(const EffectPlace& place) {
  for (const auto& slide : place.robot.slides())
    if (slide.name == place.joint) joint_ = slide.joint;
  if (!joint_) throw BadParameter(fmt::format("effect on {}: the robot has no such slide", place.component));
  force_per_N_ = place.world.physics().force_per_N;
}

double SlideEffect::rateMmPerS() const {
  return dJointGetSliderPositionRate(joint_->id());
}

void SlideEffect::addForceN(double force_N) const {
  dJointAddSliderForce(joint_->id(), force_N * force_per_N_);
}

void SlideEffect::addDryFrictionN(double force_N) const {
  joint_->addDryFriction(force_N * force_per_N_);
}

void HandEffect::attach(const EffectPlace& place) {
  robot_ = &place.robot;
  force_per_N_ = place.world.physics().force_per_N;
}

Vector HandEffect::pointMm() const {
  return robot_->handMm();
}

void HandEffect::addForceN(const Vector& force_N) const {
  const Vector force = force_N * force_per_N_, point = pointMm();
  dBodyAddForceAtPos(robot_->hand()->body().id, force.x(), force.y(), force.z(), point.x(), point.y(), point.z());
}

}  // namespace musclesim
