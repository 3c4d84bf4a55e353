/// The RoboticArm as a table of numbers: bones, the operations that put them together, and muscles.
///
/// World frame right-handed, x to the side, y up, z to the front; the arm hangs down along -y beside the ribs. Positions and sizes in mm,
/// masses in g, angles in degrees; all values are given in the world frame, in the initial pose.
///
/// Source: M. Braun, Simulating Artificial Muscles for Controlling a Robotic Arm with Fluctuation, Osaka University, 2007; the numbers of
/// the program published with it. Bones, operations and muscles 0 to 9 have these numbers unchanged.
///
/// Muscles 10 to 29 are additions of this program: 10 + k and 20 + k have the lengths of muscle k, run beside it and span the same joints.
/// At the start their beads keep at least 3 mm from the beads of every other muscle and 1.5 mm from all bones; only the first and the last
/// bead touch a bone, the one they are attached to.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace musclesim::robotic_arm {

using Triple = std::array<double, 3>;

enum class Shape { box, capped_cylinder, sphere };

/// One bone, or one part of a bone. Boxes lie along the world's axes and the cylinder part of a capped cylinder along z until rotated.
struct PrimitiveRow {
  const char* name;
  Shape shape;
  Triple position_mm;  ///< centre
  double mass_g;
  Triple size_mm;  ///< box: edges along x, y, z; capped cylinder: radius, length without the caps, 0; sphere: radius, 0, 0
};

enum class Kind {
  rotate,     ///< turn the body of `primitive` by `angle_deg` about the world's `axis` through its centre of mass
  fix,        ///< pin the body of `primitive` to the environment
  composite,  ///< make `parts` one body at their common centre of mass, oriented like `primitive`
  ball,       ///< ball joint between `primitive` and `other` at `anchor_mm`
  hinge       ///< hinge between them about the world's `axis` through `anchor_mm`, from `low_deg` to `high_deg`
};

/// One building operation. Operations act in the order of the table. A name stands for the body that its primitive belongs to at that time.
struct OperationRow {
  static constexpr std::size_t maximum_parts_count = 6;

  Kind kind;
  const char* primitive;
  const char* other = nullptr;                           ///< ball, hinge; nullptr: the environment
  std::array<const char*, maximum_parts_count> parts{};  ///< composite; nullptr after the last
  Triple anchor_mm{};                                    ///< ball, hinge
  char axis = ' ';                                       ///< rotate, hinge: 'x', 'y' or 'z'
  double angle_deg = 0.0;                                ///< rotate
  double low_deg = 0.0;                                  ///< hinge
  double high_deg = 0.0;                                 ///< hinge

  /// The names in `parts`, without empty entries.
  std::span<const char* const> partNames() const;
};

/// One muscle: a chain of links along the cubic Bezier curve start, start_control, end_control, end.
/// `connect_start_to` and `connect_end_to` name primitives; the ball joints there are anchored at start and end.
struct MuscleRow {
  const char* color_name;  ///< unique; shared by screen and plots
  Triple cap_rgb;          ///< 0..1
  Triple start_mm;
  Triple start_control_mm;
  Triple end_control_mm;
  Triple end_mm;
  double minimum_length_mm;
  double maximum_length_mm;
  const char* connect_start_to;
  const char* connect_end_to;
};

/// The 33 bones and parts of bones, in the order in which they are made.
std::span<const PrimitiveRow> primitives();

/// The 52 operations on them, in the order in which they act.
std::span<const OperationRow> operations();

/// The 30 muscles, in the order of the action and of the state; an arm with fewer muscles takes the first ones.
std::span<const MuscleRow> muscles();

}  // namespace musclesim::robotic_arm
