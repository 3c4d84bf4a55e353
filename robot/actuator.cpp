#include "musclesim/robot/actuator.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/force_law_choice.h"
#include "musclesim/robot/line_of_pull.h"
#include "musclesim/robot/primitive.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

constexpr double squeezed_mm = 1e-6;  ///< by rounding, a chain between its stops may be that much shorter than its beads

/// Axis of the hinge after a link of direction d: up x d, or x where the link is vertical.
Vector hingeAxisAfter(const Vector& d) {
  const Vector axis(d.z(), 0, -d.x());
  return axis.norm() > 0 ? axis : Vector::UnitX();
}

/// The shortest rotation from one direction to another. (Eigen's own function solves an eigenproblem for opposite directions, which costs
/// every build seconds.)
Eigen::Quaterniond rotationBetween(const Vector& from, const Vector& to) {
  const Vector a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1 + Eigen::NumTraits<double>::dummy_precision())
    return Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, a.unitOrthogonal()));
  const Vector axis = a.cross(b);
  const double s = std::sqrt((1 + cosine) * 2), inverse = 1 / s;
  return {s * 0.5, axis.x() * inverse, axis.y() * inverse, axis.z() * inverse};
}

dBodyID makeBead(dWorldID world, const Vector& position, const MuscleSettings& settings) {
  const dBodyID bead = dBodyCreate(world);
  dMass mass;
  dMassSetSphereTotal(&mass, settings.bead_mass_g, settings.bead_radius_mm);
  dBodySetMass(bead, &mass);
  dBodySetPosition(bead, position.x(), position.y(), position.z());
  return bead;
}

}  // namespace

Actuator::Actuator(dWorldID world, dSpaceID space, const std::vector<Vector>& points, double given_minimum_length_mm,
                   double minimum_length_mm, double maximum_length_mm, MuscleModel model)
    : world_(World::of(world)),
      settings_(world_.parameters(), model),
      given_minimum_length_mm_(given_minimum_length_mm),
      minimum_length_mm_(minimum_length_mm),
      maximum_length_mm_(maximum_length_mm),
      start_mm_(points.front()),
      end_mm_(points.back()),
      name_(fmt::format("muscle_{}", world_.actuators().size())) {
  double start_length_mm = 0, shortest_link_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double link_mm = (points[i + 1] - points[i]).norm();
    if (!std::isfinite(link_mm)) throw BadParameter(name_ + ": a control point is not finite");
    shortest_link_mm = std::min(shortest_link_mm, link_mm);
    start_length_mm += link_mm;
  }
  if (!settings_.line) {
    requireStartLength(start_length_mm, "start length of " + name_ + " along its curve");
    if (shortest_link_mm < 2 * settings_.bead_radius_mm)
      throw BadParameter("shortest link of " + name_, fmt::format("{:.4g} mm", shortest_link_mm),
                         fmt::format("be at least two bead radii, {} mm", 2 * settings_.bead_radius_mm));
  }
  law_ = makeForceLaw(world_.parameters(), minimum_length_mm_, maximum_length_mm_);
  if (settings_.line)
    line_ = std::make_unique<LineOfPull>(start_mm_, end_mm_);
  else
    buildLinks(dSimpleSpaceCreate(space), points);
  world_.own(this);
  takeCleanTension();
}

Actuator::~Actuator() {
  world_.disown(*this);  // it still owns this if a derived class's constructor threw
}

void Actuator::requireStartLength(double length_mm, const std::string& which) const {
  if (!(given_minimum_length_mm_ >= 0 && length_mm >= given_minimum_length_mm_ && length_mm <= maximum_length_mm_))
    throw BadParameter(
        which, fmt::format("{:.4g} mm", length_mm),
        fmt::format("lie between its minimum and maximum length, {} .. {} mm", given_minimum_length_mm_, maximum_length_mm_));
}

/// Dry friction is a motor at rest with a largest force; viscous friction one without, softened to `force` at `speed`.
void Actuator::setFriction(dJointID joint, double force, double speed) const {
  const bool slider = dJointGetType(joint) == dJointTypeSlider;
  const auto set = [&](int which, double value) {
    slider ? dJointSetSliderParam(joint, which, value) : dJointSetHingeParam(joint, which, value);
  };
  set(dParamFMax, settings_.viscous && force > 0 ? dInfinity : force);
  if (settings_.viscous && force > 0) set(dParamCFM, speed / force);
}

void Actuator::buildLinks(dSpaceID beads, const std::vector<Vector>& points) {
  const dWorldID world = world_;
  const double force_per_N = world_.physics().force_per_N;
  const double speed_ratio = std::sqrt(force_per_N / world_force_per_N);  // the original's world is slower
  const int count = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const Vector along = points[i + 1] - points[i];
    const double length_mm = along.norm();
    const Vector d = along / length_mm;
    Link link;
    const Vector centers[2] = {points[i] + settings_.bead_radius_mm * d, points[i + 1] - settings_.bead_radius_mm * d};
    for (int end = 0; end < 2; ++end) {
      link.bead[end] = makeBead(world, centers[end], settings_);
      link.geom[end] = dCreateSphere(beads, settings_.bead_radius_mm);
      dGeomSetBody(link.geom[end], link.bead[end]);
    }
    const dJointID slider = dJointCreateSlider(world, nullptr);
    dJointAttach(slider, link.bead[0], link.bead[1]);
    dJointSetSliderAxis(slider, d.x(), d.y(), d.z());
    dJointSetSliderParam(slider, dParamLoStop, length_mm - maximum_length_mm_ / count);
    dJointSetSliderParam(slider, dParamHiStop, length_mm - 2 * settings_.bead_radius_mm);
    dJointSetSliderParam(slider, dParamVel, 0);
    setFriction(slider, settings_.slider_friction_N * force_per_N, settings_.slider_viscous_speed_mm_per_s * speed_ratio);
    link.slider = &world_.addJoint(Joint::Kind::slider, slider, fmt::format("slider {} of {}", i, name_));
    if (i > 0) {
      const Vector axis = hingeAxisAfter((points[i] - points[i - 1]).normalized());
      const dJointID hinge = dJointCreateHinge(world, nullptr);
      dJointAttach(hinge, links_.back().bead[1], link.bead[0]);
      dJointSetHingeAnchor(hinge, points[i].x(), points[i].y(), points[i].z());
      dJointSetHingeAxis(hinge, axis.x(), axis.y(), axis.z());
      dJointSetHingeParam(hinge, dParamVel, 0);
      setFriction(hinge, settings_.hinge_friction_Nm * mm_per_m * force_per_N, settings_.hinge_viscous_speed_rad_per_s * speed_ratio);
      dJointSetHingeParam(hinge, dParamBounce, settings_.hinge_bounce_ratio);
      hinges_.push_back(&world_.addJoint(Joint::Kind::hinge, hinge, fmt::format("hinge {} of {}", i - 1, name_)));
    }
    links_.push_back(link);
  }
}

void Actuator::requireSameWorld(const Primitive* primitive, const std::string& which) const {
  if (primitive && dBodyGetWorld(primitive->body().id) != world_)
    throw BadParameter(
        fmt::format("the {} of {} cannot be connected to {}: they belong to different simulations", which, name_, primitive->name()));
}

Joint* Actuator::connect(dBodyID bead, const Vector& anchor, Primitive* primitive, const std::string& which) {
  const dJointID ball = dJointCreateBall(world_, nullptr);
  dJointAttach(ball, bead, primitive ? primitive->body().id : nullptr);
  dJointSetBallAnchor(ball, anchor.x(), anchor.y(), anchor.z());
  if (primitive) primitive->body().has_joint = true;
  return &world_.addJoint(Joint::Kind::ball, ball, which + " of " + name_);
}

void Actuator::connectStartTo(Primitive* primitive) {
  requireSameWorld(primitive, "start");
  if (line_) return line_->connect(LineOfPull::End::start, primitive, name_);
  if (start_joint_) throw BadParameter("the start of " + name_ + " is already connected");
  start_joint_ = connect(links_.front().bead[0], start_mm_, primitive, "start");
}

void Actuator::connectEndTo(Primitive* primitive) {
  requireSameWorld(primitive, "end");
  if (line_) return line_->connect(LineOfPull::End::end, primitive, name_);
  if (end_joint_) throw BadParameter("the end of " + name_ + " is already connected");
  end_joint_ = connect(links_.back().bead[1], end_mm_, primitive, "end");
}

LineOfPull& Actuator::openPath(const std::string& what) {
  if (!line_) throw BadParameter(what + "s are for line muscles (muscle.model = line), and " + name_ + " is a chain");
  if (path_finished_) throw BadParameter("the " + what + " of " + name_ + " comes too late: add it before the robot is complete");
  return *line_;
}

void Actuator::addViaPoint(Primitive* primitive, const Vector& point_mm) {
  LineOfPull& path = openPath("via point");
  requireSameWorld(primitive, "via point");
  path.addViaPoint(primitive, point_mm);
  takeCleanTension();
}

void Actuator::addPulley(Primitive* primitive, const Vector& center_mm, const Vector& axis, double radius_mm,
                         const std::optional<Vector>& side_mm) {
  LineOfPull& path = openPath("pulley");
  requireSameWorld(primitive, "pulley");
  path.addPulley(primitive, {center_mm, axis, radius_mm, side_mm}, name_);
  takeCleanTension();
}

void Actuator::setTendonMm(double tendon_mm) {
  openPath("tendon").setTendonMm(tendon_mm, name_);
  takeCleanTension();
}

void Actuator::finishPath() {
  if (!line_ || path_finished_) return;
  line_->requirePointsOutside(name_);
  const std::string tendon = line_->tendonMm() > 0 ? fmt::format(", without its tendon of {} mm,", line_->tendonMm()) : "";
  requireStartLength(lengthMm(), "start length of " + name_ + tendon + " along its path");
  path_finished_ = true;
}

void Actuator::moveCenter(dBodyID body, const Vector& shift_mm) {
  if (line_) line_->moveCenter(body, shift_mm);
}

double Actuator::calculateForce(double pressure_ratio, double length_mm) const {
  return law_->tensionN(pressure_ratio, length_mm);
}

double Actuator::cleanTensionN(double pressure_ratio) const {
  const double force_N = calculateForce(pressure_ratio, lengthMm());
  const bool may_push = !line_ && world_.physics().kind != PhysicsKind::si;
  return force_N < 0 && !may_push && std::isfinite(force_N) ? 0 : force_N;
}

/// After a change of the muscle itself: the tension before any stage has run.
void Actuator::takeCleanTension() {
  world_.values().tension_N[worldIndex()] = cleanTensionN(pressure());
}

void Actuator::requireCommand(double command_ratio) const {
  if (!(command_ratio >= 0 && command_ratio <= 1))
    throw BadParameter("command of " + name_, fmt::format("{}", command_ratio), "lie in 0 .. 1");
}

void Actuator::setPressure(double command_ratio) {
  requireCommand(command_ratio);
  world_.values().command_ratio[worldIndex()] = command_ratio;
}

void Actuator::setForceLaw(std::unique_ptr<ForceLaw> law) {
  if (!law) throw BadParameter("force law of " + name_ + ": there is none");
  law_ = std::move(law);
  takeCleanTension();
}

void Actuator::setColor(double red, double green, double blue, const std::string& name) {
  color_ = {red, green, blue, name};
}

void Actuator::setName(const std::string& name) {
  name_ = name;
}

double Actuator::lengthMm() const {
  if (line_) return line_->lengthMm();
  double sum_mm = 0;
  for (const Link& link : links_) sum_mm += (positionOf(link.bead[0]) - positionOf(link.bead[1])).norm();
  return sum_mm + static_cast<double>(links_.size()) * 2 * settings_.bead_radius_mm;
}

double Actuator::lengthRatio() const {
  return (lengthMm() - minimum_length_mm_) / (maximum_length_mm_ - minimum_length_mm_);
}

double Actuator::massG() const {
  return 2 * static_cast<double>(links_.size()) * settings_.bead_mass_g;
}

Actuator::LengthRange Actuator::straightLengthRange() const {
  if (line_) return {minimum_length_mm_, maximum_length_mm_};
  return {static_cast<double>(links_.size()) * 2 * settings_.bead_radius_mm, maximum_length_mm_};
}

void Actuator::placeStraight(const Vector& start_mm, const Vector& end_mm) {
  if (line_) return takeCleanTension();
  const double radius = settings_.bead_radius_mm;
  const auto count = static_cast<double>(links_.size());
  const Vector along = end_mm - start_mm;
  const double length_mm = along.norm();
  if (!(length_mm >= count * 2 * radius - squeezed_mm && std::isfinite(length_mm)))
    throw BadParameter("straight length of " + name_, fmt::format("{:.4g} mm", length_mm),
                       fmt::format("be at least its beads' diameters, {} mm", count * 2 * radius));
  // The beads keep their orientation against the chain, so all hinges stay at their reference where the chain was built straight.
  const Vector built = end_mm_ - start_mm_;
  const Eigen::Matrix3d turn = rotationBetween(built, along).toRotationMatrix();
  const Vector d = along / length_mm;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Vector first = start_mm + along * (static_cast<double>(i) / count) + radius * d;
    const Vector second = start_mm + along * (static_cast<double>(i + 1) / count) - radius * d;
    for (int end = 0; end < 2; ++end) {
      const Vector& center = end == 0 ? first : second;
      dBodySetPosition(links_[i].bead[end], center.x(), center.y(), center.z());
      setRotation(links_[i].bead[end], turn);
      dBodySetLinearVel(links_[i].bead[end], 0, 0, 0);
      dBodySetAngularVel(links_[i].bead[end], 0, 0, 0);
    }
  }
  takeCleanTension();
}

}  // namespace musclesim
