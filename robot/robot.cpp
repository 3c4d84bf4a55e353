#include "musclesim/robot/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/base/error.h"
#include "settling.h"

namespace musclesim {

namespace {

thread_local Robot* active_robot = nullptr;

}  // namespace

Robot* Robot::getActiveRobot() {
  if (!active_robot) throw BadParameter("this thread has no current simulation with a robot");
  return active_robot;
}

void Robot::setActiveRobot(Robot* robot) {
  active_robot = robot;
}

double Robot::parameter(const std::string& name, double default_value, const std::string& unit, double minimum, double maximum,
                        const std::string& description) const {
  return world_.parameters().number(name, default_value, unit, minimum, maximum, description);
}

void Robot::requireTolerances() const {
  for (const auto& [name, tolerance] : parameterTolerances()) requireTolerance(name);
}

void Robot::requireTolerance(const std::string& name) const {
  const auto isOfTheRun = [&](const Parameter& p) { return p.name == "force_law.name" && p.value == p.default_value; };
  const bool default_law = std::ranges::any_of(world_.parameters().declared(), isOfTheRun);
  if (name.starts_with("force_law.") && !default_law) return;
  world_.parameters().requireScalable(name);
}

namespace {

template <class Part, class Options>
Part& named(Part* part, const Options& options) {
  if (!options.name.empty()) part->setName(options.name);
  return *part;
}

}  // namespace

Box& Robot::addBox(const BoxOptions& o) {
  return named(new Box(world_, space(), o.center_mm, o.mass_g, o.density_g_per_mm3, o.size_mm.x(), o.size_mm.y(), o.size_mm.z()), o);
}

Sphere& Robot::addSphere(const SphereOptions& o) {
  return named(new Sphere(world_, space(), o.center_mm, o.mass_g, o.density_g_per_mm3, o.radius_mm), o);
}

CappedCylinder& Robot::addCapsule(const CapsuleOptions& o) {
  return named(new CappedCylinder(world_, space(), o.center_mm, o.mass_g, o.density_g_per_mm3, o.radius_mm, o.length_mm), o);
}

Muscle& Robot::addMuscle(const MuscleOptions& o) {
  const Vector& start = o.from.point_mm;
  const Vector third = (o.to.point_mm - start) / 3;
  auto* muscle =
      new Muscle(world_, space(), start, start + third, start + 2 * third, o.to.point_mm, o.length_mm.minimum, o.length_mm.maximum);
  muscle->connectStartTo(o.from.primitive);
  muscle->connectEndTo(o.to.primitive);
  addActuator(muscle);
  return named(muscle, o);
}

void Robot::addActuator(Actuator* actuator) {
  actuators_.push_back(actuator);
}

void Robot::addAngle(const std::string& name, Joint* joint, int axis) {
  angles_.push_back({name, joint, axis});
}

void Robot::addSlide(const std::string& name, Joint* joint) {
  slides_.push_back({name, joint});
}

void Robot::countTurns(bool from_zero) const {
  for (const Angle& angle : angles_) angle.joint->countTurns(from_zero);
}

void Robot::setHand(Primitive* primitive, const Vector& offset_mm) {
  hand_ = primitive;
  hand_offset_mm_ = offset_mm;
  hand_reported_ = true;
}

void Robot::setLoad(Primitive* primitive, const Vector& offset_mm) {
  hand_ = primitive;
  hand_offset_mm_ = offset_mm;
}

std::vector<Color> Robot::namedMuscleColors() const {
  std::vector<Color> colors;
  for (const Actuator* actuator : actuators_)
    if (!actuator->color().name.empty()) colors.push_back(actuator->color());
  return colors;
}

void Robot::loadHand(double mass_g) {
  const Vector point = handMm();
  hand_->addPointMass(mass_g, point);
  hand_offset_mm_ = hand_->getRotation().transpose() * (point - hand_->getPosition());
}

Vector Robot::mounted(MuscleEnd end, const Vector& place_mm, const Vector& lever) {
  const int muscle = actuatorCount();
  mounted_ends_.insert({muscle, end});
  return place_mm + world_.effects().mountOffsetMm(muscle, end, lever.normalized());
}

Vector Robot::handMm() const {
  return hand_->getPosition() + hand_->getRotation() * hand_offset_mm_;
}

void Robot::settle() {
  placeAtRest(world_);
}

State Robot::getState() const {
  State state = truth();
  world_.effects().read(state);
  return state;
}

State Robot::truth() const {
  State state;
  state.time_s = world_.clock().time_s();
  for (auto* quantity : {&state.command, &state.pressure, &state.force_N, &state.length_mm}) quantity->reserve(actuators_.size());
  for (const Actuator* actuator : actuators_) {
    state.command.push_back(actuator->command());
    state.pressure.push_back(actuator->pressure());
    state.force_N.push_back(actuator->tensionN());
    state.length_mm.push_back(actuator->lengthMm());
  }
  state.angle_deg.reserve(angles_.size());
  for (const Angle& angle : angles_) state.angle_deg.push_back(angle.joint->angleDeg(angle.axis));
  if (hand_reported_) state.hand_mm = handMm();
  return state;
}

void Robot::step(const Action& action) {
  if (action.size() != actuators_.size())
    throw BadParameter("number of commanded pressures", fmt::format("{}", action.size()),
                       fmt::format("be {}, one per muscle", actuators_.size()));
  for (std::size_t i = 0; i < action.size(); ++i) {
    if (!std::isfinite(action[i]))
      throw Diverged(world_.clock().time_s(), fmt::format("command_{}", i), fmt::format("the commanded pressure is {}", action[i]));
    actuators_[i]->requireCommand(action[i]);
  }
  for (std::size_t i = 0; i < action.size(); ++i) actuators_[i]->setPressure(action[i]);
  world_.effects().update();
}

std::vector<std::string> Robot::signalNames() const {
  std::vector<std::string> names;
  for (const char* form : {"command_{}", "pressure_{}", "force_{}_N", "length_{}_mm"})
    for (std::size_t i = 0; i < actuators_.size(); ++i) names.push_back(fmt::format(fmt::runtime(form), i));
  for (const Angle& angle : angles_) names.push_back("angle_" + angle.name + "_deg");
  if (hand_reported_)
    for (const char* axis : {"x", "y", "z"}) names.push_back(fmt::format("hand_{}_mm", axis));
  return names;
}

std::vector<double> Robot::signalValues(const State& state) const {
  constexpr std::size_t kinds_of_muscle_signals = 4, coordinates = 3;
  std::vector<double> values;
  values.reserve(kinds_of_muscle_signals * actuators_.size() + angles_.size() + coordinates);
  for (const auto* quantity : {&state.command, &state.pressure, &state.force_N, &state.length_mm, &state.angle_deg})
    values.insert(values.end(), quantity->begin(), quantity->end());
  if (hand_reported_) {
    const Vector hand = state.hand_mm.value_or(Vector::Constant(std::numeric_limits<double>::quiet_NaN()));
    values.insert(values.end(), {hand.x(), hand.y(), hand.z()});
  }
  return values;
}

void Robot::setSignalValues(const std::vector<double>& values, State& state) const {
  auto next = values.begin();
  for (auto* quantity : {&state.command, &state.pressure, &state.force_N, &state.length_mm, &state.angle_deg})
    for (double& value : *quantity) value = *next++;
  if (state.hand_mm) *state.hand_mm = Vector(next[0], next[1], next[2]);
}

}  // namespace musclesim
