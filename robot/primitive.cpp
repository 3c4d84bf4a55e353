#include "musclesim/robot/primitive.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "ode_vector.h"
#include "vector_checks.h"

namespace musclesim {

namespace {

constexpr double pi = std::numbers::pi;

double positive(const std::string& what, double value) {
  if (!(value > 0) || !std::isfinite(value)) throw BadParameter(what, fmt::format("{}", value), "be positive and finite");
  return value;
}

double volumeMm3(const Shape& shape) {
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      return s.x() * s.y() * s.z();
    case Shape::Kind::sphere:
      return 4.0 / 3.0 * pi * s.x() * s.x() * s.x();
    case Shape::Kind::cylinder:
      return pi * s.x() * s.x() * s.y();
    case Shape::Kind::capped_cylinder:
      return pi * s.x() * s.x() * s.y() + 4.0 / 3.0 * pi * s.x() * s.x() * s.x();
  }
  return 0;
}

/// Total mass and inertia of a solid of this shape about its centre, in its own axes.
dMass solid(const Shape& shape, double mass_g) {
  dMass mass;
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      dMassSetBoxTotal(&mass, mass_g, s.x(), s.y(), s.z());
      break;
    case Shape::Kind::sphere:
      dMassSetSphereTotal(&mass, mass_g, s.x());
      break;
    case Shape::Kind::cylinder:
      dMassSetCylinderTotal(&mass, mass_g, 3, s.x(), s.y());
      break;
    case Shape::Kind::capped_cylinder:
      dMassSetCapsuleTotal(&mass, mass_g, 3, s.x(), s.y());
      break;
  }
  return mass;
}

dGeomID makeGeom(dSpaceID space, const Shape& shape) {
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      return dCreateBox(space, s.x(), s.y(), s.z());
    case Shape::Kind::sphere:
      return dCreateSphere(space, s.x());
    case Shape::Kind::cylinder:
      return dCreateCylinder(space, s.x(), s.y());
    case Shape::Kind::capped_cylinder:
      return dCreateCapsule(space, s.x(), s.y());
  }
  return nullptr;
}

}  // namespace

Primitive::Primitive(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, Shape shape)
    : world_(World::of(world)), shape_(std::move(shape)) {
  requireFinite("position of a primitive", position);
  if (!(density >= 0) || !std::isfinite(density))
    throw BadParameter("density of a primitive", fmt::format("{}", density), "be finite and not negative");
  if (mass == 0) mass = positive("density of a primitive without mass", density) * volumeMm3(shape_);
  mass_g_ = positive("mass of a primitive", mass);
  const dBodyID id = dBodyCreate(world);
  const dMass solid_mass = solid(shape_, mass_g_);
  dBodySetMass(id, &solid_mass);
  dBodySetPosition(id, position.x(), position.y(), position.z());
  geom_ = makeGeom(space, shape_);  // a null space: drawn, but never in contact
  dGeomSetBody(geom_, id);
  world_.own(this);
  name_ = fmt::format("primitive_{}", worldIndex());
  body_ = &world_.addBody(id, *this);
}

Primitive::~Primitive() {
  dGeomDestroy(geom_);
  std::erase(body_->parts, this);
  world_.disown(*this);  // it still owns this if a derived class's constructor threw
}

Vector Primitive::getPosition() const {
  return positionOf(body_->id);
}

Eigen::Matrix3d Primitive::getRotation() const {
  return rotationOf(body_->id);
}

void Primitive::setColor(double red, double green, double blue) {
  for (double component : {red, green, blue})
    if (!(component >= 0 && component <= 1)) throw BadParameter("colour of " + name_, fmt::format("{}", component), "lie in 0 .. 1");
  color_.red = red;
  color_.green = green;
  color_.blue = blue;
}

void Primitive::rotate(double angle_deg, const Vector& axis) {
  requireDirection("axis of rotation of " + name_, axis);
  if (!std::isfinite(angle_deg)) throw BadParameter("angle of rotation of " + name_, fmt::format("{}", angle_deg), "be finite");
  if (body_->has_joint) throw BadParameter("rotate " + name_ + ": it already has a joint, whose anchor would be left behind");
  const Eigen::AngleAxisd turn(angle_deg * rad_per_deg, axis.normalized());
  setRotation(body_->id, turn.toRotationMatrix() * getRotation());
}

void Primitive::place(const Vector& position_mm, const Eigen::Matrix3d& rotation) {
  requireFinite("position of " + name_, position_mm);
  dBodySetPosition(body_->id, position_mm.x(), position_mm.y(), position_mm.z());
  setRotation(body_->id, rotation);
  dBodySetLinearVel(body_->id, 0, 0, 0);
  dBodySetAngularVel(body_->id, 0, 0, 0);
}

Box::Box(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double x, double y, double z)
    : Primitive(world, space, position, mass, density,
                {Shape::Kind::box, {positive("edge of a box", x), positive("edge of a box", y), positive("edge of a box", z)}}) {}

Sphere::Sphere(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius)
    : Primitive(world, space, position, mass, density, {Shape::Kind::sphere, {positive("radius of a sphere", radius), 0, 0}}) {}

CappedCylinder::CappedCylinder(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius,
                               double length)
    : Primitive(world, space, position, mass, density,
                {Shape::Kind::capped_cylinder,
                 {positive("radius of a capped cylinder", radius), positive("length of a capped cylinder", length), 0}}) {}

Cylinder::Cylinder(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius, double length)
    : Primitive(world, space, position, mass, density,
                {Shape::Kind::cylinder, {positive("radius of a cylinder", radius), positive("length of a cylinder", length), 0}}) {}

}  // namespace musclesim
