#include "musclesim/controller/task.h"

#include <fmt/format.h>

#include <cmath>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double largest_target_mm = 1e5;
constexpr double largest_hand_mm = 1e9;

/// Declares one coordinate of a target. A target in the request overrides it.
double coordinate(const ControllerRequest& request, const std::string& name, double default_mm, int axis, const std::string& meaning) {
  if (request.target_mm) request.parameters.set(name, (*request.target_mm)[axis], "target");
  return request.parameters.number(name, default_mm, "mm", -largest_target_mm, largest_target_mm, meaning);
}

BadParameter unknownTask(const std::string& task) {
  const std::string nearest = nearestName(task, {"height", "reach"});
  return BadParameter("task", task, "be height or reach" + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

}  // namespace

Vector reportedHand(const State& state) {
  if (!state.hand_mm)
    throw BadParameter(
        "the task needs a robot that reports the position of its hand; this robot does not: use a controller without a task, for "
        "example --controller hold or random");
  const Vector& hand = *state.hand_mm;
  // Written so that NaN fails too.
  if (!(hand.cwiseAbs().array() <= largest_hand_mm).all())
    throw Diverged(state.time_s, "hand", fmt::format("position ({}, {}, {}) mm is beyond any robot's reach", hand.x(), hand.y(), hand.z()));
  return hand;
}

double Target::distanceMm(const State& state) const {
  const Vector difference = reportedHand(state) - point_mm;
  return is_height ? std::abs(difference.y()) : difference.norm();  // Eq. 8
}

Target Target::make(const ControllerRequest& request) {
  Target target;
  if (request.task == "height") {
    target.is_height = true;
    target.point_mm.y() = coordinate(request, "height_task.target_mm", 0, 1, "height the hand should have");
  } else if (request.task == "reach") {
    target.point_mm.x() = coordinate(request, "reach_task.target_x_mm", -300, 0, "point the hand should reach, to the side");
    target.point_mm.y() = coordinate(request, "reach_task.target_y_mm", 0, 1, "point the hand should reach, up");
    target.point_mm.z() = coordinate(request, "reach_task.target_z_mm", 150, 2, "point the hand should reach, to the front");
  } else {
    throw unknownTask(request.task);
  }
  return target;
}

void Task::requireKnown(const std::string& task) {
  if (task != "height" && task != "reach") throw unknownTask(task);
}

std::unique_ptr<Task> Task::make(const ControllerRequest& request) {
  if (request.task == "height") return std::make_unique<HeightTask>(request);
  if (request.task == "reach") return std::make_unique<ReachTask>(request);
  throw unknownTask(request.task);
}

HeightTask::HeightTask(const ControllerRequest& request)
    : Task(Target::make(request)),
      gain_(request.parameters.number("height_task.gain", 1, "", 0, 1e6, "activity at the target")),
      e0_mm_(request.parameters.number("height_task.error_scale_mm", 20, "mm", 1e-3, 1e5,
                                       "height error at which the activity is half of that at the target")) {}

double HeightTask::activity(const State& state) {
  return gain_ * e0_mm_ / (target().distanceMm(state) + e0_mm_);
}

ReachTask::ReachTask(const ControllerRequest& request)
    : Task(Target::make(request)),
      d_scale_mm_(request.parameters.number("reach_task.distance_scale_mm", 100, "mm", 1e-3, 1e5,
                                            "the activity is 1 if the hand is this much nearer than its mean distance")),
      mean_d_(request.parameters.number("reach_task.discount", 0.98, "", 1e-3, 1, "discount factor of past distances per decision")) {}

double ReachTask::activity(const State& state) {
  const double d = target().distanceMm(state);                 // Eq. 8
  const double alpha = (mean_d_.meanOr(d) - d) / d_scale_mm_;  // Eq. 7
  mean_d_.add(d);                                              // Eq. 9
  return alpha;
}

}  // namespace musclesim
