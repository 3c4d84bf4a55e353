/// What a robot file says, before it is built: docs/reference/robot_format.md describes the format.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "table_reader.h"

namespace musclesim::description {

struct ParameterEntry {
  std::string name, unit, meaning;
  double value, minimum, maximum;
};

/// What is known of a number of the model.
struct ToleranceEntry {
  std::string name;  ///< of the parameter, with its group
  double tolerance;  ///< relative standard deviation
  FilePlace place;
};

/// One rigid shape.
struct Part {
  std::string name;  ///< of a part beside the first; empty: the body's name with a number
  std::string type;  ///< box, sphere, capsule, cylinder, none
  QuantityVector size_mm;
  Quantity radius_mm, length_mm;
  QuantityVector at_mm;
  std::vector<std::pair<Quantity, QuantityVector>> turns;  ///< angle in degrees, axis of the world, in this order
  std::optional<Quantity> mass_g, density_g_per_mm3;
  std::optional<QuantityVector> color;
  FilePlace place;
};

struct BodyEntry {
  std::string name;
  std::vector<Part> parts;                                       ///< at least one
  std::string axes_of;                                           ///< the part that gives the body its axes; empty: the first
  std::vector<std::pair<Quantity, QuantityVector>> whole_turns;  ///< of the whole about its centre of mass
  std::vector<Quantity> inertia_g_mm2;                           ///< none, 3 or 6 numbers
  std::optional<QuantityVector> center_of_mass_mm;
  bool fixed, collides, free;
  FilePlace place;
};

struct JointEntry {
  std::string name, type, body, to;
  QuantityVector at_mm;
  std::optional<QuantityVector> axis, axis2, axis3;
  std::optional<std::array<Quantity, 2>> limits, limits2, limits3;  ///< degrees, mm for sliders
  std::optional<Quantity> friction, damping, stiffness, rest;       ///< in the units of the joint's kind
  bool report;
  FilePlace place;
};

struct PulleyEntry {
  std::string name, body;
  QuantityVector at_mm;
  std::optional<QuantityVector> axis;  ///< none: a sphere
  Quantity radius_mm;
  FilePlace place;
};

/// Where a muscle or a spring ends.
struct End {
  std::string body;
  QuantityVector at_mm;
  std::optional<QuantityVector> lever;  ///< direction in which the effect attachment_offset moves the end
  bool may_be_off;                      ///< whether that effect may move it
  FilePlace place;
};

/// A via point or a pulley on a muscle's way.
struct PathPoint {
  std::string body, pulley;  ///< one of them is empty
  std::optional<QuantityVector> at_mm, side_mm;
  FilePlace place;
};

struct ForceLawEntry {
  std::string name;
  std::map<std::string, Quantity> parameters;
  FilePlace place;
};

struct MuscleEntry {
  std::string name;
  End from, to;
  std::array<Quantity, 2> length_mm;
  std::string model;  ///< chain, line, or empty: that of the run
  std::vector<QuantityVector> control_mm;
  std::vector<PathPoint> path;
  std::optional<Quantity> tendon_mm, rest_length_mm;
  std::optional<ForceLawEntry> force_law;
  std::optional<QuantityVector> color;
  std::string color_name;
  // Linear actuators only:
  std::string force_N;  ///< expression over p, l_mm and the parameters; empty: the force law
  bool commanded = true;
  FilePlace place;
};

struct SpringEntry {
  std::string name;
  End from, to;
  Quantity stiffness_N_per_mm, rest_mm;
  std::optional<Quantity> damping_Ns_per_m;
  bool pulls_only;
  FilePlace place;
};

struct WallEntry {
  std::string body;  ///< empty: the hand's
  QuantityVector at_mm, normal;
  Quantity stiffness_N_per_mm;
  FilePlace place;
};

struct HandEntry {
  std::string body;
  std::optional<QuantityVector> at_mm;
  bool report;
  FilePlace place;
};

struct Description {
  std::string file, name, hash, summary, start_state;
  std::vector<ParameterEntry> parameters;
  std::vector<ToleranceEntry> tolerances;
  std::vector<BodyEntry> bodies;
  std::vector<JointEntry> joints;
  std::vector<PulleyEntry> pulleys;
  std::vector<MuscleEntry> muscles, actuators;
  std::vector<SpringEntry> springs;
  std::vector<WallEntry> walls;
  std::optional<HandEntry> hand;
};

/// Reads and checks everything that does not depend on numbers: keys, types, names and references. Throws BadFile.
Description readDescription(const std::string& text, const std::string& file);

}  // namespace musclesim::description
