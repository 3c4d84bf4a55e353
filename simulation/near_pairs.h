/// Pairs of geoms that may touch: bounds of what they can have moved in place of a test of all pairs at every step.
#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace musclesim {

/// From one call to the next a body moves each of its points by
///     |x - x_0| + r angle(q, q_0)
/// at most; x, q its pose, 0 that of the call before, r the farthest point of its geoms from x. These bounds are summed up over all calls.
/// A pair that is apart by d is looked at again when the sums of its bodies have grown by d. d is the distance of the spheres about all
/// geoms of either body, or that of the two geoms' bounding boxes along the farthest axis, or that along the farthest of the geoms' own
/// axes.
class NearPairs {
 public:
  explicit NearPairs(dSpaceID space) : space_(space) {}
  /// Calls `near` for the pairs that may touch, in the order of dSpaceCollide, but not for pairs of one body and of two that are joined.
  /// `revision` must be another one wherever bodies, joints or geoms have been added, removed or put together. Spaces that are not simple,
  /// or hold others, are left to dSpaceCollide. All geoms must be enabled and meet all others.
  void collide(long revision, void* data, dNearCallback* near);

 private:
  using Box = std::array<dReal, 6>;  ///< low and high per axis
  /// A box with half sides of this length in the geom's own axes, and all that is no farther from it than the radius.
  struct RoundedBox {
    bool known = false;
    double half_mm[3] = {}, radius_mm = 0;
  };
  struct Geom {
    dGeomID id;
    std::size_t body;  ///< among bodies_
    RoundedBox shape;
    long box_time;  ///< when the box was read
    Box box;
  };
  struct Body {
    dBodyID id;  ///< null: the environment
    double reach_mm;
    dVector3 position;
    dQuaternion orientation;
  };
  struct Pair {
    std::array<std::size_t, 2> geom;  ///< among geoms_
    double due_mm;                    ///< sum of what both bodies have moved when it must be looked at
  };
  struct BodyPair {
    std::size_t body[2];               ///< among bodies_
    std::size_t first_pair, end_pair;  ///< of its geoms, among pairs_
    double due_mm;                     ///< of the first of them
  };
  void moveBodies();
  bool holdsTheGeoms() const;
  bool haveMovedFar() const;
  void makeList();
  void listPairs();
  std::size_t placeOf(dBodyID body);
  static void extend(Body& body, const Box& box);
  void look(BodyPair& bodies, double moved_mm);
  const Box& boxOf(std::size_t number);
  static RoundedBox roundedBoxOf(dGeomID geom);
  static double ownDistanceMm(const Geom& a, const Geom& b);
  static double distanceMm(const Box& a, const Box& b);

  dSpaceID space_;
  bool left_to_space_ = false;  ///< ODE is asked
  long revision_ = -1;          ///< at the last call
  long time_ = 0;               ///< number of calls
  std::vector<Geom> geoms_;
  std::vector<Body> bodies_;
  std::vector<double> moved_mm_;  ///< of the bodies, at most, since the list was made
  std::vector<Pair> pairs_;
  std::vector<BodyPair> body_pairs_;
  std::vector<std::array<std::size_t, 2>> found_;  ///< pairs of geoms whose boxes touch
};

}  // namespace musclesim
