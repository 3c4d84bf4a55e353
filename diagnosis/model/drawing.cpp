#include "drawing.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "../../simulation/snapshot.h"

namespace musclesim {

namespace {

/// A bone as a thick line along its longest extent.
RobotDrawing::Line lineOf(const DrawnPart& part) {
  Eigen::Vector3f half = Eigen::Vector3f::Zero();
  float width = 2 * part.size_mm.x();
  if (part.kind == Shape::Kind::capped_cylinder || part.kind == Shape::Kind::cylinder) half.z() = part.size_mm.y() / 2;
  if (part.kind == Shape::Kind::box) {
    Eigen::Index longest = 0;
    part.size_mm.maxCoeff(&longest);
    half[longest] = part.size_mm[longest] / 2;
    width = part.size_mm[(longest + 1) % 3];
  }
  auto placed = [&](const Eigen::Vector3f& point) -> Eigen::Vector2d { return (part.pose * point.homogeneous()).head<2>().cast<double>(); };
  return {"", {placed(-half), placed(half)}, width, "bone"};
}

}  // namespace

RobotDrawing drawingOf(Simulation& simulation) {
  const Snapshot snapshot = SnapshotTaker(simulation).take(simulation.robot().truth());
  RobotDrawing drawing;
  for (const DrawnPart& part : snapshot.parts) drawing.lines.push_back(lineOf(part));
  for (const DrawnSpring& spring : snapshot.springs) {
    RobotDrawing::Line line{"", {}, 2 * spring.radius_mm, "spring"};
    for (const Eigen::Vector3f& point : spring.points_mm) line.points_mm.push_back(point.head<2>().cast<double>());
    drawing.lines.push_back(std::move(line));
  }
  for (std::size_t i = 0; i < snapshot.hoses.size(); ++i) {
    RobotDrawing::Line line{fmt::format("muscle_{}", i), {}, 2 * snapshot.hoses[i].radius_mm, simulation.robot().actuators()[i]->name()};
    for (const Eigen::Vector3f& point : snapshot.hoses[i].points_mm) line.points_mm.push_back(point.head<2>().cast<double>());
    drawing.lines.push_back(std::move(line));
  }
  for (const Robot::Angle& angle : simulation.robot().angles()) {
    for (const DrawnFrame& frame : snapshot.frames)
      if (frame.name == angle.name) drawing.points.push_back({"joint_" + angle.name, frame.pose.block<2, 1>(0, 3).cast<double>()});
  }
  for (const Robot::Slide& slide : simulation.robot().slides()) {
    const dBodyID first = dJointGetBody(slide.joint->id(), 0);
    const dReal* center = dBodyGetPosition(first ? first : dJointGetBody(slide.joint->id(), 1));
    drawing.points.push_back({"slide_" + slide.name, {center[0], center[1]}});
  }
  if (simulation.robot().hand()) drawing.points.push_back({"hand", simulation.robot().handMm().head<2>()});
  return drawing;
}

}  // namespace musclesim
