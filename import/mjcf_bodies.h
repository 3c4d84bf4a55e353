/// Bodies, geoms, joints and sites of an MJCF file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjcf_document.h"
#include "source_robot.h"

namespace musclesim {

struct MjcfGeom {
  std::string name;
  std::size_t body = 0;
  SourceShape shape;       ///< in the frame of the body
  bool has_shape = false;  ///< false: a plane, height field or mesh
  bool is_pulley = false;  ///< a muscle wraps around it
};

/// What is read so far, with what later sections refer to by name.
struct MjcfModel {
  SourceRobot robot;
  std::vector<MjcfGeom> geoms;
  std::map<std::string, SourcePoint> sites;
  std::map<std::string, std::size_t> bodies;
  std::map<std::string, std::size_t> body_of_joint;
};

/// Reads <worldbody> into the model. Shapes of geoms are not given to the bodies yet, see drawGeoms.
void readMjcfBodies(const MjcfDocument& document, MjcfModel& model);

/// Gives every body the shapes of its geoms that are not pulleys.
void drawGeoms(MjcfModel& model);

}  // namespace musclesim
