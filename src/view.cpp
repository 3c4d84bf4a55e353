#include "view.h"

#include <fmt/format.h>

#include "musclesim/base/error.h"

namespace musclesim::command_line {

namespace {

float require(const char* name, float value, float low, float high) {
  if (!(value >= low && value <= high))
    throw BadParameter(std::string("camera's ") + name, fmt::format("{}", value), fmt::format("lie in {} .. {}", low, high));
  return value;
}

}  // namespace

Camera initialCamera(const std::string& robot_name, const Snapshot& snapshot, const std::vector<float>& given) {
  const Bounds bounds = boundsOf(snapshot);
  Camera camera = robot_name == "arm" ? Camera{} : Camera::framing(bounds.low, bounds.high);
  if (robot_name == "arm" && snapshot.floor_mm) {
    camera.center_mm.y() -= 80;
    camera.distance_mm = 1450;
  }
  if (given.empty()) return camera;
  camera.azimuth_deg = require("azimuth", given.at(0), -360, 360);
  camera.elevation_deg = require("elevation", given.at(1), -89, 89);
  camera.distance_mm = require("distance", given.at(2), 50, 20000);
  return camera;
}

}  // namespace musclesim::command_line
