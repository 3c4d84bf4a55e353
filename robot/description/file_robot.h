/// Builds the robot that a file describes.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "description.h"
#include "expressions.h"
#include "musclesim/robot/robot.h"

namespace musclesim::description {

/// Declares the file's parameters under the robot's name, evaluates all expressions and builds bodies, fixed joints, other joints, muscles,
/// springs, walls and the hand, in this order. Throws BadFile with the place of the entry that cannot be built.
class FileRobot final : public Robot {
 public:
  FileRobot(World& world, std::shared_ptr<const Description> description);
  std::string initialState() const override { return description_->start_state; }
  std::map<std::string, double> parameterTolerances() const override;
  void requireTolerances() const override;
  const Description& description() const { return *description_; }

 private:
  Expressions declareParameters() const;
  Primitive* buildPart(const Part& part, bool massless, bool collides) const;
  void buildBody(const BodyEntry& entry);
  void setMassProperties(const BodyEntry& entry, Primitive& body) const;
  void buildJoint(const JointEntry& entry);
  Joint* attach(const JointEntry& entry, Primitive& body, Primitive* other) const;
  void addMechanics(const JointEntry& entry, Joint& joint) const;
  Actuator* buildMuscle(const MuscleEntry& entry);
  Actuator* buildActuator(const MuscleEntry& entry);
  void finish(const MuscleEntry& entry, Actuator& actuator);
  void buildPath(const MuscleEntry& entry, Actuator& muscle) const;
  std::unique_ptr<ForceLaw> forceLaw(const MuscleEntry& entry, double shortest_mm, double longest_mm) const;
  void buildSpring(const SpringEntry& entry) const;
  void buildWall(const WallEntry& entry) const;
  void buildHand(const HandEntry& entry);
  Vector leverOf(const MuscleEntry& entry, const End& end) const;
  Primitive* find(const std::string& name) const;

  std::shared_ptr<const Description> description_;
  Expressions value_;
  std::map<std::string, Primitive*> bodies_;
  std::map<std::string, Joint*> joints_;
};

}  // namespace musclesim::description
