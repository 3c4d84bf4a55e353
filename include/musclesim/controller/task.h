/// Tasks of the attractor controllers: a target of the hand, and an activity that says how well the arm does.
#pragma once

#include <memory>

#include "musclesim/controller/attractors.h"
#include "musclesim/controller/controller.h"

namespace musclesim {

/// The reported hand of a robot, mm, world frame. Throws BadParameter if the robot reports none, Diverged if it is not finite or farther
/// than 1e9 mm from the origin in any direction.
Vector reportedHand(const State& state);

/// Where the hand should be: a height or a point, mm, world frame (y up).
struct Target {
  Vector point_mm = Vector::Zero();
  bool is_height = false;  ///< only the y component counts

  /// Eq. 8, d(t): distance between hand and target, mm, at least 0; for a height |y_hand - y_target|. Throws as reportedHand.
  double distanceMm(const State& state) const;

  /// The target of the request's task. "height": height_task.target_mm (0 mm). "reach": reach_task.target_x_mm, _y_mm, _z_mm
  /// (-300, 0, 150 mm). If request.target_mm is given, it replaces these parameters. Throws BadParameter for an unknown task (the message
  /// gives the nearest name) and for coordinates out of range.
  static Target make(const ControllerRequest& request);
};

/// Tells a controller once per decision how well the arm does.
class Task {
 public:
  virtual ~Task() = default;
  /// Activity alpha, a pure number, at this decision; to be called exactly once per decision. Throws as reportedHand.
  virtual double activity(const State& state) = 0;
  Vector targetMm() const { return target_.point_mm; }
  bool targetIsHeight() const { return target_.is_height; }
  void moveTarget(const Vector& target_mm) { target_.point_mm = target_mm; }

  /// Throws BadParameter if no task has this name; the message gives the nearest name.
  static void requireKnown(const std::string& task);
  /// The task named in the request. Throws as Target::make.
  static std::unique_ptr<Task> make(const ControllerRequest& request);

 protected:
  explicit Task(const Target& target) : target_(target) {}
  const Target& target() const { return target_; }

 private:
  Target target_;
};

/// Lift the hand to a height: the activity is inversely proportional to the height error, regularised.
///     alpha = gain e0 / (d + e0),   d = |y_hand - y_target|
/// d, e0 in mm; gain, alpha pure numbers. alpha lies in (0, gain]: it is gain at the target and gain / 2 at d = e0.
/// Source: Braun 2007, Section 6 (inverse proportionality); e0 keeps it finite.
class HeightTask final : public Task {
 public:
  /// Declares height_task.target_mm, height_task.gain (1), height_task.error_scale_mm (e0).
  explicit HeightTask(const ControllerRequest& request);
  double activity(const State& state) override;

 private:
  double gain_, e0_mm_;
};

/// Move the hand to a point: the activity is positive while the hand is nearer to the target than its past mean.
///     alpha(t) = (mean d(t) - d(t)) / d_scale                                            (Eq. 7)
///     d(t) = |hand - target|                                                             (Eq. 8)
///     mean d(t) = sum_{k=1..t} gamma^k d(t-k) / sum_{k=1..t} gamma^k, recursively A / B   (Eq. 9, see DiscountedMean)
/// d, d_scale in mm; t counts decisions. alpha can have either sign. It is 0 at the first decision, where mean d is d itself.
/// Source: Braun 2007, Section 5, in the form written here; d_scale is the scale of this implementation.
class ReachTask final : public Task {
 public:
  /// Declares reach_task.target_x_mm, _y_mm, _z_mm, reach_task.discount (gamma), reach_task.distance_scale_mm (d_scale).
  explicit ReachTask(const ControllerRequest& request);
  double activity(const State& state) override;

 private:
  double d_scale_mm_;
  DiscountedMean mean_d_;
};

}  // namespace musclesim
