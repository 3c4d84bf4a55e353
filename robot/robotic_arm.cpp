#include "musclesim/robot/robotic_arm.h"

#include <map>
#include <string>

#include "musclesim/robot/muscle.h"
#include "robotic_arm_table.h"

namespace musclesim {

namespace {

using robotic_arm::Kind;
using robotic_arm::MuscleRow;
using robotic_arm::OperationRow;
using robotic_arm::PrimitiveRow;
using robotic_arm::Triple;

Vector toVector(const Triple& t) {
  return {t[0], t[1], t[2]};
}

Vector axisFromLetter(char letter) {
  return letter == 'x' ? Vector::UnitX() : letter == 'y' ? Vector::UnitY() : Vector::UnitZ();
}

Primitive* makePrimitive(dWorldID world, dSpaceID space, const PrimitiveRow& row) {
  const Vector position = toVector(row.position_mm);
  const auto [a, b, c] = row.size_mm;
  switch (row.shape) {
    case robotic_arm::Shape::box:
      return new Box(world, space, position, row.mass_g, 0, a, b, c);
    case robotic_arm::Shape::capped_cylinder:
      return new CappedCylinder(world, space, position, row.mass_g, 0, a, b);
    case robotic_arm::Shape::sphere:
      return new Sphere(world, space, position, row.mass_g, 0, a);
  }
  return nullptr;
}

using Bones = std::map<std::string, Primitive*>;

Primitive* find(const Bones& bones, const char* name) {
  return name ? bones.at(name) : nullptr;
}

/// Carries out one building operation; returns the joint it made, if it made one.
Joint* perform(const OperationRow& row, const Bones& bones) {
  Primitive* primitive = find(bones, row.primitive);
  switch (row.kind) {
    case Kind::rotate:
      primitive->rotate(row.angle_deg, axisFromLetter(row.axis));
      return nullptr;
    case Kind::fix:
      primitive->fix();
      return nullptr;
    case Kind::composite: {
      std::vector<Primitive*> parts;
      for (const char* name : row.partNames()) parts.push_back(find(bones, name));
      Primitive::compositePrimitives(parts, primitive);
      return nullptr;
    }
    case Kind::ball:
      return primitive->attachBall(find(bones, row.other), toVector(row.anchor_mm));
    case Kind::hinge:
      return primitive->attachHinge(find(bones, row.other), toVector(row.anchor_mm), axisFromLetter(row.axis), row.low_deg, row.high_deg);
  }
  return nullptr;
}

/// The joint that a muscle spans, by the bone that it ends on.
Vector spannedJoint(const MuscleRow& muscle) {
  const std::string end = muscle.connect_end_to;
  const char* bone = end.starts_with("medius") ? "pollex" : end.starts_with("ulna") || end.starts_with("radius") ? "ulna" : "humerus";
  for (const OperationRow& row : robotic_arm::operations())
    if ((row.kind == Kind::hinge || row.kind == Kind::ball) && std::string(row.primitive) == bone) return toVector(row.anchor_mm);
  return Vector::Zero();
}

/// From the joint to the straight line between the muscle's ends, perpendicular to it.
Vector leverOf(const MuscleRow& muscle) {
  const Vector start = toVector(muscle.start_mm), along = (toVector(muscle.end_mm) - start).normalized();
  const Vector from_joint = start - spannedJoint(muscle);
  return from_joint - along.dot(from_joint) * along;
}

}  // namespace

RoboticArm::RoboticArm(World& world) : Robot(world) {
  world.setCompositeInertia(compositeInertiaFromName(world.parameters().choice(
      "arm.composite_inertia", nameOf(world.physics().composite_inertia), {"exact", "summed"}, "inertia of the arm's composite bones")));
  const int muscle_count = world.parameters().integer("arm.muscle_count", 10, 1, static_cast<int>(robotic_arm::muscles().size()),
                                                      "number of muscles, the first ones of the table");
  Bones bones;
  for (const PrimitiveRow& row : robotic_arm::primitives()) {
    bones[row.name] = makePrimitive(world, space(), row);
    bones[row.name]->setName(row.name);
  }
  for (const OperationRow& row : robotic_arm::operations()) {
    Joint* joint = perform(row, bones);
    if (row.kind == Kind::hinge) addAngle(std::string(row.primitive) == "ulna" ? "elbow" : "wrist", joint);
  }
  for (int i = 0; i < muscle_count; ++i) {
    const auto& row = robotic_arm::muscles()[static_cast<std::size_t>(i)];
    auto* muscle = new Muscle(world, space(), mountedStart(toVector(row.start_mm), leverOf(row)), toVector(row.start_control_mm),
                              toVector(row.end_control_mm), mountedEnd(toVector(row.end_mm), leverOf(row)), row.minimum_length_mm,
                              row.maximum_length_mm);
    muscle->connectStartTo(find(bones, row.connect_start_to));
    muscle->connectEndTo(find(bones, row.connect_end_to));
    muscle->setColor(row.cap_rgb[0], row.cap_rgb[1], row.cap_rgb[2], row.color_name);
    addActuator(muscle);
  }
  setHand(bones.at("medius"));
}

}  // namespace musclesim
