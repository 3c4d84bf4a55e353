/// Pairs of geoms that may touch: bounds of what they can have moved in place of a test of all pairs at every step.
#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace musclesim {

/// From one call to the next a body moves each of its points by
///     |x - x_0| + r angle(q, q_0)
/// at most; x, q its pose, 0 that of the call before, r the farthest point of its geoms from x. These bounds are summed up over all calls.
/// A pair whose bounding boxes are apart by d along their farthest axis is looked at again when the sums of its bodies have grown by d.
class NearPairs {
 public:
  explicit NearPairs(dSpaceID space) : space_(space) {}
  /// Calls `near` for the same pairs in the same order as dSpaceCollide, but for pairs of one body and of two that were joined at the first
  /// call.
  void collide(void* data, dNearCallback* near);

 private:
  using Box = std::array<dReal, 6>;  ///< low and high per axis
  struct Geom {
    dGeomID id;
    int body;  ///< among bodies_
    bool box_is_read;
    Box box;
  };
  struct Body {
    dBodyID id;  ///< null: the environment
    double reach_mm;
    dVector3 position;
    dQuaternion orientation;
  };
  struct Pair {
    int geom[2], body[2];  ///< among geoms_ and bodies_
    double due_mm;         ///< sum of what both bodies have moved when it must be looked at
  };
  void moveBodies();
  bool listIsGood() const;
  void makeList();
  void listStrangers();
  bool areStrangers(int first, int second) const;
  int placeOf(dBodyID body);
  void extend(int number, const Box& box);
  const Box& boxOf(int number);
  static double distanceMm(const Box& a, const Box& b);

  dSpaceID space_;
  bool has_subspaces_ = false;  ///< ODE is asked then
  std::vector<Geom> geoms_;
  std::vector<Body> bodies_;
  std::vector<double> moved_mm_;  ///< of the bodies, at most, since the list was made
  std::vector<char> strangers_;   ///< of every two bodies
  std::vector<Pair> pairs_;
};

}  // namespace musclesim
