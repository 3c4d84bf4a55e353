/// Broad phase: finds the pairs of geoms that may touch. Bounds on their motion replace a test of all pairs at every step.
#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace musclesim {

/// From one call to the next a body moves each of its points by at most
///     |x - x_0| + r angle(q, q_0)
/// x, q is the body's pose, index 0 its pose at the previous call, r the distance from x to the farthest point of its geoms. These bounds
/// are summed over all calls. A pair at distance d is tested again when the sums of its two bodies have grown by d. d is a lower bound of
/// the distance: between the spheres around all geoms of each body, or between the bounding boxes of the two geoms along the world axis
/// that separates them most, or between the two geoms along the one of their own axes that separates them most.
class BroadPhase {
 public:
  explicit BroadPhase(dSpaceID space) : space_(space) {}
  /// Calls `near` for the pairs that may touch, in the order of dSpaceCollide. Pairs on the same body or on two joined bodies are left out.
  /// `revision` must change whenever bodies, joints or geoms are added, removed or combined. For a space that is not a simple space, or
  /// that contains other spaces, this calls dSpaceCollide. All geoms must be enabled, and each must be allowed to collide with every other.
  void collide(long revision, void* data, dNearCallback* near);

 private:
  using Box = std::array<dReal, 6>;  ///< low and high per axis
  /// All points within `radius_mm` of a box that has half edges `half_mm` along the geom's own axes.
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
    double due_mm;                    ///< the pair is tested again when moved_mm_ of both bodies add up to this
  };
  struct BodyPair {
    std::size_t body[2];               ///< among bodies_
    std::size_t first_pair, end_pair;  ///< range of its pairs of geoms in pairs_
    double due_mm;                     ///< least due_mm of these pairs
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
  bool left_to_space_ = false;  ///< dSpaceCollide does the work
  long revision_ = -1;          ///< at the last call
  long time_ = 0;               ///< number of calls
  std::vector<Geom> geoms_;
  std::vector<Body> bodies_;
  std::vector<double> moved_mm_;  ///< per body: bound on its motion since the list was made
  std::vector<Pair> pairs_;
  std::vector<BodyPair> body_pairs_;
  std::vector<std::array<std::size_t, 2>> found_;  ///< pairs of geoms whose boxes touch
};

}  // namespace musclesim
