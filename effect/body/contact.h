/// Body stage: a joint, the hand or the load meets a wall.
///     joint:  torque = -k max(0, s (q - q_w)) s        q angle in deg, q_w = plane_deg, k = stiffness_Nm_per_deg
///     hand:   force = -k max(0, s (x - x_w)) s e       x the hand's coordinate along the axis e, x_w = plane_mm, k = stiffness_N_per_mm
/// s = +1: the wall is above the plane's coordinate, s = -1: below it; with side = auto, s is the sign of that coordinate. The wall is
/// frictionless and elastic.
/// Neutral: both stiffnesses 0. Ranges 0 .. 1000 N m/deg and 0 .. 1e5 N/mm.  Source: penalty contact.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

/// A wall across one coordinate.
struct Wall {
  double plane, stiffness;
  bool beyond;  ///< true: the wall is above `plane`; false: below
  /// Force along the coordinate.
  double push(double coordinate) const;
};

class JointContact final : public JointEffect {
 public:
  explicit JointContact(const Wall& wall) : wall_(wall) {}
  void apply(const StepTime&) override { addTorqueNm(wall_.push(angleDeg())); }

 private:
  Wall wall_;
};

class HandContact final : public HandEffect {
 public:
  HandContact(const Wall& wall, const Vector& axis) : wall_(wall), axis_(axis) {}
  void apply(const StepTime&) override { addForceN(wall_.push(pointMm().dot(axis_)) * axis_); }

 private:
  Wall wall_;
  Vector axis_;
};

/// A JointContact or a HandContact, depending on the component.
class Contact final : public BodyEffect {
 public:
  explicit Contact(EffectValues values) : values_(std::move(values)) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void apply(const StepTime& time) override { contact_->apply(time); }

 private:
  Wall wallAt(const std::string& plane, const std::string& stiffness) const;

  EffectValues values_;
  std::unique_ptr<BodyEffect> contact_;
};

}  // namespace musclesim
