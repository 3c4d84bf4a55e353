/// Bones: boxes, spheres and capped cylinders, alone or joined to composites.
///
/// World frame: right-handed, x to the side, y up, z to the front. Lengths in mm, masses in g, angles in degrees.
/// Primitives are created with `new` as in the paper and owned by the world in which they are built; do not delete them.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "musclesim/robot/body.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/state.h"
#include "musclesim/robot/world.h"

namespace musclesim {

/// The form of a primitive, for whoever draws it.
struct Shape {
  enum class Kind { box, sphere, capped_cylinder, cylinder };
  Kind kind;
  Vector size_mm;  ///< box: edges along x, y, z; sphere: radius, 0, 0; capped cylinder: radius, length without the caps (along z), 0;
                   ///< cylinder: radius, length (along z), 0
};

/// Limits of one joint axis in degrees, from the pose as built. They contain 0 and lie in -175 .. 175, the second of a ball joint in
/// -85 .. 85: ODE's angles wrap beyond, and stops need room for what a body overshoots.
struct Limits {
  double low_deg, high_deg;
};

/// A point of the world in the pose as built, mm, and the primitive that it is fixed to (null: the environment).
struct Attachment {
  Primitive* primitive = nullptr;
  Vector point_mm = Vector::Zero();
};

/// A hinge by named fields.
struct HingeOptions {
  std::optional<Vector> anchor_mm = {};   ///< a point of the world; default: the centre of mass of the body
  Vector axis = Vector::UnitZ();          ///< a direction in the world
  std::optional<Limits> limits_deg = {};  ///< default: none
};

/// One part of a robot's skeleton.
///
/// All functions throw BadParameter for values that are not finite or out of range.
class Primitive : public WorldPart {
 public:
  ~Primitive() override;

  /// Turns the whole body about its centre of mass by a right-handed angle about an axis of the world.
  void rotate(double angle_deg, const Vector& axis);
  /// Pins the body to the environment.
  void fix();
  /// Replaces the moments of inertia about the body's own axes, g mm^2. Throws BadParameter unless all are positive.
  void setInertia(const Vector& moments_g_mm2);
  /// Adds a point mass to the body at a point of the world; negative: takes one away. Mass, centre of mass and inertia follow; joints,
  /// line muscles and drawing stay. Only while the robot stands as built. Throws BadParameter unless mass and moments of inertia stay
  /// positive.
  void addPointMass(double mass_g, const Vector& point_mm);
  /// Replaces mass, centre of mass and inertia of the whole body. `center_mm`: a point of the world in the present pose; `inertia`: about
  /// that point, in the body's own axes, g mm^2. Joints and drawing stay. Only while the robot stands as built. Throws BadParameter unless
  /// the mass is positive and the inertia is that of a body: its principal moments I_1 <= I_2 <= I_3 are positive and I_3 <= I_1 + I_2.
  void setMassProperties(double mass_g, const Vector& center_mm, const Eigen::Matrix3d& inertia);
  /// Moves the body (with all its parts) to a position of its centre of mass and an orientation, at rest. Joints keep their reference.
  void place(const Vector& position_mm, const Eigen::Matrix3d& rotation);
  void setColor(double red, double green, double blue);
  void setName(const std::string& name) { name_ = name; }
  /// Whether pictures show it (default: they do).
  void setVisible(bool visible) { visible_ = visible; }
  bool isVisible() const { return visible_; }

  /// Ball joint to `other` (null: the environment) at a point of the world.
  Joint* attachBall(Primitive* other, const Vector& anchor);
  /// Ball joint with limits on the three Euler angles of `this` against `other`: about the first axis (fixed to `this`), the second
  /// (across both) and the third (fixed to `other`).
  Joint* attachBall(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis3, Limits limits1, Limits limits2,
                    Limits limits3);
  /// Hinge with one axis.
  Joint* attachHinge(Primitive* other, const Vector& anchor, const Vector& axis);
  Joint* attachHinge(Primitive* other, const Vector& anchor, const Vector& axis, double low_deg, double high_deg);
  /// Hinge with two axes (ODE's hinge-2): the first fixed to `this`, the second to `other`, which must not be the environment.
  /// With limits the axes must be perpendicular.
  Joint* attachHinge(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2);
  Joint* attachHinge(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2, Limits limits1, Limits limits2);
  /// Universal joint with two axes, which must be perpendicular.
  Joint* attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2);
  Joint* attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2, Limits limits1, Limits limits2);
  /// Universal joint with one axis: the second is perpendicular to it and locked.
  Joint* attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis);
  Joint* attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis, double low_deg, double high_deg);

  /// The same joint as attachHinge, by named fields:
  ///     bar.hingeToWorld({.axis = Vector::UnitZ(), .limits_deg = Limits{-40, 40}});
  Joint& hingeToWorld(const HingeOptions& options) { return hinge(nullptr, options); }
  Joint& hingeTo(Primitive& other, const HingeOptions& options) { return hinge(&other, options); }
  /// A point of the world, fixed to this primitive: where a muscle starts or ends.
  Attachment at(const Vector& point_mm) { return {this, point_mm}; }

  /// Slider along an axis of the world; it also keeps the body from turning.
  Joint* attachSlider(Primitive* other, const Vector& axis);

  /// Makes `other` (with all it is composed of) a part of this primitive's body, which keeps this primitive's orientation.
  /// Throws BadParameter if either already has a joint or is fixed.
  void compositeWithPrimitive(Primitive* other);
  /// Joins all parts to one body at their common centre of mass, oriented like `parent` (default: the last part).
  static void compositePrimitives(const std::vector<Primitive*>& parts, Primitive* parent = nullptr);

  const std::string& name() const { return name_; }
  const Color& color() const { return color_; }
  const Shape& shape() const { return shape_; }
  dGeomID geom() const { return geom_; }
  Body& body() const { return *body_; }
  double massG() const { return mass_g_; }
  /// Centre of mass of the body this primitive belongs to, world frame, mm.
  Vector getPosition() const;
  /// Orientation of that body: columns are its axes in the world frame.
  Eigen::Matrix3d getRotation() const;

 protected:
  /// `mass` in g; if it is 0, the mass follows from `density` in g/mm^3 and the volume.
  Primitive(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, Shape shape);

 private:
  Joint* addJoint(Joint::Kind kind, dJointID joint, Primitive* other, const std::string& what);
  Joint& hinge(Primitive* other, const HingeOptions& options);
  void requireComposable() const;
  void takeMassProperties(double mass_g, const Vector& center_mm, const Eigen::Matrix3d& inertia);
  static void merge(Body& target, const std::vector<Body*>& bodies, Primitive& parent);

  World& world_;
  Shape shape_;
  double mass_g_;
  dGeomID geom_ = nullptr;
  Body* body_ = nullptr;
  Color color_;
  bool visible_ = true;
  std::string name_;
};

/// Primitives by named fields, for Robot::addBox and its like. Either the mass or the density is given.
struct BoxOptions {
  double mass_g = 0, density_g_per_mm3 = 0;
  Vector center_mm = Vector::Zero();  ///< in the world
  Vector size_mm = Vector::Zero();    ///< edges along x, y, z
  std::string name = {};
};
struct SphereOptions {
  double mass_g = 0, density_g_per_mm3 = 0;
  Vector center_mm = Vector::Zero();
  double radius_mm = 0;
  std::string name = {};
};
/// The capsule lies along z; `length_mm` is without the caps.
struct CapsuleOptions {
  double mass_g = 0, density_g_per_mm3 = 0;
  Vector center_mm = Vector::Zero();
  double radius_mm = 0, length_mm = 0;
  std::string name = {};
};

/// A box with edges x, y, z (mm).
class Box : public Primitive {
 public:
  Box(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double x, double y, double z);
};

/// A sphere.
class Sphere : public Primitive {
 public:
  Sphere(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius);
};

/// A cylinder along z with half spheres at both ends; `length` without them.
class CappedCylinder : public Primitive {
 public:
  CappedCylinder(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius, double length);
};

/// A cylinder along z, with flat ends.
class Cylinder : public Primitive {
 public:
  Cylinder(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius, double length);
};

}  // namespace musclesim
