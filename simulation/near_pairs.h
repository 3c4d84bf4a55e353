/// Pairs of geoms that may touch soon: a neighbour list (Verlet 1967) in place of a test of all pairs at every step.
#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace musclesim {

/// The list holds the pairs whose bounding boxes are nearer than a skin along every axis, with their distance along the farthest. A body
/// can have moved any of its points by
///     m = |x - x_0| + r angle(q, q_0)
/// at most; x, q its pose, 0 when the list was made, r the farthest point of its geoms from x. A pair is looked at when the m of both
/// bodies add up to its distance; the list is made anew when two bodies could have crossed the skin.
class NearPairs {
 public:
  explicit NearPairs(dSpaceID space) : space_(space) {}
  /// Calls `near` for the same pairs in the same order as dSpaceCollide, but for pairs of one body or of two that a joint connects.
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
    double moved_mm;  ///< at most
  };
  struct Pair {
    int first, second;  ///< among geoms_
    double distance_mm;
  };
  bool listIsGood();
  void makeList();
  void listStrangers();
  bool areStrangers(int first, int second) const;
  int placeOf(dBodyID body);
  static void extend(Body& body, const Box& box);
  const Box& boxOf(int number);
  static double distanceMm(const Box& a, const Box& b);
  Body& bodyOf(int geom) { return bodies_[static_cast<std::size_t>(geoms_[static_cast<std::size_t>(geom)].body)]; }

  dSpaceID space_;
  bool has_subspaces_ = false;  ///< ODE is asked then
  std::vector<Geom> geoms_;
  std::vector<Body> bodies_;
  std::vector<char> strangers_;  ///< of every two bodies
  std::vector<Pair> pairs_;
};

}  // namespace musclesim
