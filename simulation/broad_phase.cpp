#include "broad_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace musclesim {

namespace {

constexpr double most_moved_mm = 1e5;  ///< above this the list is made again, before the sums lose digits
constexpr double rounding_mm = 1e-6;   ///< rounding error of the sums

double difference(const dReal* a, const dReal* b, int count) {
  double square = 0;
  for (int i = 0; i < count; ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square);
}

}  // namespace

void BroadPhase::collide(long revision, void* data, dNearCallback* near) {
  const bool known = revision == revision_ && holdsTheGeoms();
  if (known) moveBodies();
  if (!known || haveMovedFar()) makeList();
  revision_ = revision;
  if (left_to_space_) return dSpaceCollide(space_, data, near);
  ++time_;
  found_.clear();
  for (BodyPair& bodies : body_pairs_) {
    const double moved_mm = moved_mm_[bodies.body[0]] + moved_mm_[bodies.body[1]];
    if (moved_mm >= bodies.due_mm) look(bodies, moved_mm);
  }
  std::ranges::sort(found_);
  for (const auto& [first, second] : found_) near(data, geoms_[first].id, geoms_[second].id);
}

void BroadPhase::look(BodyPair& bodies, double moved_mm) {
  const Body &first = bodies_[bodies.body[0]], &second = bodies_[bodies.body[1]];
  const double apart_mm = difference(first.position, second.position, 3) - first.reach_mm - second.reach_mm;
  if (apart_mm > 0) {
    bodies.due_mm = moved_mm + apart_mm - rounding_mm;
    return;
  }
  bodies.due_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = bodies.first_pair; i < bodies.end_pair; ++i) {
    Pair& pair = pairs_[i];
    if (moved_mm >= pair.due_mm) {
      double distance_mm = distanceMm(boxOf(pair.geom[0]), boxOf(pair.geom[1]));
      if (distance_mm == 0) distance_mm = ownDistanceMm(geoms_[pair.geom[0]], geoms_[pair.geom[1]]);
      if (distance_mm == 0) found_.push_back(pair.geom);
      pair.due_mm = moved_mm + distance_mm - rounding_mm;
    }
    bodies.due_mm = std::min(bodies.due_mm, pair.due_mm);
  }
}

/// Adds the bounds on the bodies' motion since the last call.
void BroadPhase::moveBodies() {
  // |q - q_0| = 2 sin(angle / 4), so angle <= pi / sqrt(2) |q - q_0| up to half a turn.
  constexpr double most_angle_per_difference = 2.23;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (!body.id) continue;
    const dReal *position = dBodyGetPosition(body.id), *orientation = dBodyGetQuaternion(body.id);
    moved_mm_[i] +=
        difference(position, body.position, 3) + body.reach_mm * most_angle_per_difference * difference(orientation, body.orientation, 4);
    std::copy_n(position, 3, body.position);
    std::copy_n(orientation, 4, body.orientation);
  }
}

/// Whether the list still matches the space. The space puts new or moved geoms in front, so comparing the count and the first geom is
/// enough.
bool BroadPhase::holdsTheGeoms() const {
  const std::size_t count = geoms_.size();
  if (count != static_cast<std::size_t>(dSpaceGetNumGeoms(space_))) return false;
  return left_to_space_ || count == 0 || dSpaceGetGeom(space_, 0) == geoms_.front().id;
}

bool BroadPhase::haveMovedFar() const {
  return std::ranges::any_of(moved_mm_, [](double mm) { return mm > most_moved_mm; });
}

void BroadPhase::makeList() {
  geoms_.clear();
  bodies_.clear();
  moved_mm_.clear();
  const int count = dSpaceGetNumGeoms(space_);
  left_to_space_ = dSpaceGetClass(space_) != dSimpleSpaceClass;
  for (int i = 0; i < count; ++i) {
    const dGeomID geom = dSpaceGetGeom(space_, i);
    left_to_space_ = left_to_space_ || dGeomIsSpace(geom);
    geoms_.push_back({geom, dGeomIsSpace(geom) ? 0 : placeOf(dGeomGetBody(geom)), roundedBoxOf(geom), 0, {}});
  }
  if (left_to_space_) return bodies_.clear();
  moved_mm_.resize(bodies_.size());
  time_ = 1;
  for (std::size_t i = 0; i < geoms_.size(); ++i) extend(bodies_[geoms_[i].body], boxOf(i));
  listPairs();
}

/// Lists all pairs of geoms on two different bodies that no joint connects.
void BroadPhase::listPairs() {
  pairs_.clear();
  body_pairs_.clear();
  for (std::size_t first = 0; first < bodies_.size(); ++first)
    for (std::size_t second = first + 1; second < bodies_.size(); ++second) {
      const dBodyID a = bodies_[first].id, b = bodies_[second].id;
      if (a && b && dAreConnected(a, b)) continue;
      BodyPair bodies = {{first, second}, pairs_.size(), 0, 0};
      for (std::size_t i = 0; i < geoms_.size(); ++i)
        for (std::size_t j = i + 1; j < geoms_.size(); ++j)
          if (std::minmax(geoms_[i].body, geoms_[j].body) == std::minmax(first, second)) pairs_.push_back({{i, j}, 0});
      bodies.end_pair = pairs_.size();
      body_pairs_.push_back(bodies);
    }
  found_.reserve(pairs_.size());
}

/// Index of a body in bodies_. Adds a new body together with its pose.
std::size_t BroadPhase::placeOf(dBodyID body) {
  const auto found = std::ranges::find(bodies_, body, &Body::id);
  if (found != bodies_.end()) return static_cast<std::size_t>(found - bodies_.begin());
  Body& added = bodies_.emplace_back(Body{body, 0, {}, {}});
  if (body) {
    std::copy_n(dBodyGetPosition(body), 3, added.position);
    std::copy_n(dBodyGetQuaternion(body), 4, added.orientation);
  }
  return bodies_.size() - 1;
}

/// Extends the body's reach by a geom with this bounding box.
void BroadPhase::extend(Body& body, const Box& box) {
  double square = 0;  // infinite for a plane
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double farthest = std::max(std::abs(box[2 * axis] - body.position[axis]), std::abs(box[2 * axis + 1] - body.position[axis]));
    square += farthest * farthest;
  }
  body.reach_mm = std::max(body.reach_mm, std::sqrt(square));
}

const BroadPhase::Box& BroadPhase::boxOf(std::size_t number) {
  Geom& geom = geoms_[number];
  if (geom.box_time != time_) dGeomGetAABB(geom.id, geom.box.data());
  geom.box_time = time_;
  return geom.box;
}

/// The geom as a rounded box; not known for other shapes.
BroadPhase::RoundedBox BroadPhase::roundedBoxOf(dGeomID geom) {
  RoundedBox box = {true, {}, 0};
  switch (dGeomGetClass(geom)) {
    case dBoxClass: {
      dVector3 sides;
      dGeomBoxGetLengths(geom, sides);
      for (int i = 0; i < 3; ++i) box.half_mm[i] = sides[i] / 2;
      return box;
    }
    case dCapsuleClass:
      dGeomCapsuleGetParams(geom, &box.radius_mm, &box.half_mm[2]);
      box.half_mm[2] /= 2;
      return box;
    case dSphereClass:
      box.radius_mm = dGeomSphereGetRadius(geom);
      return box;
    default:
      return {};
  }
}

/// Distance along the geoms' own axis that separates them most; 0 if they overlap on all axes or a shape is unknown.
double BroadPhase::ownDistanceMm(const Geom& a, const Geom& b) {
  if (!a.shape.known || !b.shape.known) return 0;
  const dReal *ra = dGeomGetRotation(a.id), *rb = dGeomGetRotation(b.id);
  const dReal *xa = dGeomGetPosition(a.id), *xb = dGeomGetPosition(b.id);
  const double way[3] = {xb[0] - xa[0], xb[1] - xa[1], xb[2] - xa[2]};
  const auto along = [](const dReal* r, int axis, const double* v) { return r[axis] * v[0] + r[4 + axis] * v[1] + r[8 + axis] * v[2]; };
  double reach_of_a[3] = {}, farthest = 0;  // half width of a's box along b's axes
  const double radii = a.shape.radius_mm + b.shape.radius_mm;
  for (int i = 0; i < 3; ++i) {
    const double axis[3] = {ra[i], ra[4 + i], ra[8 + i]};
    double reach_of_b = 0;
    for (int j = 0; j < 3; ++j) {
      const double cosine = std::abs(along(rb, j, axis));
      reach_of_b += b.shape.half_mm[j] * cosine;
      reach_of_a[j] += a.shape.half_mm[i] * cosine;
    }
    farthest = std::max(farthest, std::abs(along(ra, i, way)) - a.shape.half_mm[i] - reach_of_b - radii);
  }
  for (int j = 0; j < 3; ++j) farthest = std::max(farthest, std::abs(along(rb, j, way)) - b.shape.half_mm[j] - reach_of_a[j] - radii);
  return farthest;
}

/// Distance along the axis that separates the boxes most; 0 if they overlap or touch.
double BroadPhase::distanceMm(const Box& a, const Box& b) {
  double farthest = 0;
  for (std::size_t axis = 0; axis < 6; axis += 2) farthest = std::max({farthest, a[axis] - b[axis + 1], b[axis] - a[axis + 1]});
  return farthest;
}

}  // namespace musclesim
