#include "scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "shaders.h"

namespace musclesim {

namespace {

using V = Eigen::Vector3f;
using M = Eigen::Matrix4f;

constexpr float background = 0.9F, hose_grey = 0.2F;
const V selected_color(0.80F, 0.06F, 0.06F), target_color(1.0F, 0.10F, 0.10F), shadow_color(0.80F, 0.805F, 0.815F),
    ghost_color(0.10F, 0.42F, 0.95F), contact_color(0.95F, 0.50F, 0.0F), pull_color(0.72F, 0.05F, 0.72F);
constexpr float level_radius_mm = 220, target_alpha = 0.45F, bone_alpha = 0.35F, ghost_alpha = 0.42F;
constexpr float ghost_margin_mm = 1.5F;  ///< by which a ghost is larger all around, so that it can be seen where the poses agree
constexpr float grid_mm = 100, floor_reach_mm = 1600;
constexpr float cap_cone_in_radii = 1.5F, cap_length_in_radii = 3.0F, cap_width_ratio = 1.2F;
constexpr float frame_mm = 45, frame_radius_mm = 1.6F;
constexpr float tension_mm_per_N = 1, shortest_tension_N = 0.5F, longest_tension_mm = 150, tension_radius_mm = 2.5F;
constexpr float contact_mm = 30, contact_radius_mm = 1.5F, pull_radius_mm = 4;

M scaled(float x, float y, float z) {
  return Eigen::Vector4f(x, y, z, 1).asDiagonal();
}

M moved(const V& by) {
  M m = M::Identity();
  m.topRightCorner<3, 1>() = by;
  return m;
}

/// Maps the z axis from 0 to 1 to the line from one point to another, and scales x and y by a radius.
M between(const V& from, const V& to, float radius) {
  M m = M::Identity();
  const V along = to - from;
  m.topLeftCorner<3, 3>() = Eigen::Quaternionf::FromTwoVectors(V::UnitZ(), along).toRotationMatrix();
  m.topRightCorner<3, 1>() = from;
  return m * scaled(radius, radius, along.norm());
}

/// The point of a curve at a given distance from its beginning.
V pointAt(const std::vector<V>& curve, float distance) {
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const float piece = (curve[i + 1] - curve[i]).norm();
    if (piece >= distance && piece > 0) return curve[i] + (curve[i + 1] - curve[i]) * (distance / piece);
    distance -= piece;
  }
  return curve.back();
}

/// A curve shortened by a length at each end, which the caps hide.
std::vector<V> trimmed(const std::vector<V>& curve, float at_each_end) {
  float length = 0;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) length += (curve[i + 1] - curve[i]).norm();
  if (length <= 2 * at_each_end) return curve;
  std::vector<V> middle = {pointAt(curve, at_each_end)};
  float reached = 0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    reached += (curve[i] - curve[i - 1]).norm();
    if (reached > at_each_end && reached < length - at_each_end) middle.push_back(curve[i]);
  }
  middle.push_back(pointAt(curve, length - at_each_end));
  return middle;
}

V rgb(const Color& color) {
  return Eigen::Vector3d(color.red, color.green, color.blue).cast<float>();
}

}  // namespace

Color tensionColor(double tension_N) {
  constexpr double full_N = 100;
  const V stops[] = {{0.16F, 0.16F, 0.22F}, {0.18F, 0.35F, 0.75F}, {0.20F, 0.72F, 0.72F}, {1.0F, 0.86F, 0.20F}};
  const double place = std::clamp(tension_N / full_N, 0.0, 1.0) * 3;
  const int first = std::min(static_cast<int>(place), 2);
  const auto part = static_cast<float>(place - first);
  const V mixed = stops[first] * (1 - part) + stops[first + 1] * part;
  return {mixed.x(), mixed.y(), mixed.z(), ""};
}

/// A mesh with its pose and colour.
struct Scene::Item {
  const GpuMesh* mesh;
  M model;
  V color;
  float alpha = 1, shine = 0.12F;
  bool has_shadow = true;
};

Scene::Scene(const Gl& gl)
    : gl_(gl),
      solid_(gl, shaders::vertex, shaders::solid_fragment),
      floor_(gl, shaders::vertex, shaders::floor_fragment),
      box_(gl, boxMesh()),
      sphere_(gl, sphereMesh(10)),
      fine_sphere_(gl, sphereMesh(20)),
      cylinder_(gl, turnedMesh({{1, 0}, {1, 1}})),
      disc_cylinder_(gl, turnedMesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}})),
      cap_(gl, turnedMesh({{0, -0.06F}, {0.30F, -0.04F}, {0.45F, 0.02F}, {1, 0.5F}, {1, 1}, {0.8F, 1.04F}, {0, 1.04F}})),
      cone_(gl, turnedMesh({{0, 0}, {1, 0}, {0, 1}})),
      square_(gl, squareMesh()) {}

Scene::~Scene() = default;

void Scene::addPart(std::vector<Item>& items, const DrawnPart& part, float alpha) const {
  const V& s = part.size_mm;
  const V color = rgb(part.color);
  if (part.kind == Shape::Kind::box) {
    items.push_back({&box_, part.pose * scaled(s.x(), s.y(), s.z()), color, alpha, 0.02F});
    return;
  }
  if (part.kind == Shape::Kind::sphere) {
    items.push_back({&sphere_, part.pose * scaled(s.x(), s.x(), s.x()), color, alpha});
    return;
  }
  const V half(0, 0, s.y() / 2);
  if (part.kind == Shape::Kind::cylinder) {
    items.push_back({&disc_cylinder_, part.pose * between(-half, half, s.x()), color, alpha});
    return;
  }
  for (const V& end : {V(-half), half}) items.push_back({&sphere_, part.pose * moved(end) * scaled(s.x(), s.x(), s.x()), color, alpha});
  items.push_back({&cylinder_, part.pose * between(-half, half, s.x()), color, alpha});
}

/// A coloured sleeve over the end of a hose, which tapers to the attachment.
void Scene::addCap(std::vector<Item>& items, const std::vector<V>& curve, const DrawnHose& hose) const {
  const V& tip = curve.front();
  const V end = pointAt(curve, cap_length_in_radii * hose.radius_mm);
  if ((end - tip).norm() < 1e-3F) return;
  items.push_back({&cap_, between(tip, end, cap_width_ratio * hose.radius_mm), rgb(hose.color)});
}

void Scene::addHose(std::vector<Item>& items, const DrawnHose& hose, std::size_t index, const SceneStyle& style) {
  std::vector<V> curve = smoothCurve(hose.points_mm);
  while (tubes_.size() <= index) tubes_.push_back(std::make_unique<GpuMesh>(gl_));
  tubes_[index]->load(tubeMesh(trimmed(curve, cap_cone_in_radii * hose.radius_mm), hose.radius_mm), GL_STREAM_DRAW);
  V color = V::Constant(hose_grey);
  if (style.color_tension) color = rgb(tensionColor(hose.tension_N));
  if (static_cast<int>(index) == style.selected) color = selected_color;
  items.push_back({tubes_[index].get(), M::Identity(), color, 1, 0.22F});
  addCap(items, curve, hose);
  std::reverse(curve.begin(), curve.end());
  addCap(items, curve, hose);
}

void Scene::addFrame(std::vector<Item>& items, const DrawnFrame& frame) const {
  const V origin = frame.pose.topRightCorner<3, 1>();
  for (int axis = 0; axis < 3; ++axis) {
    const V end = origin + frame_mm * frame.pose.block<3, 1>(0, axis), color = V::Constant(0.1F) + 0.75F * V::Unit(axis);
    items.push_back({&cylinder_, between(origin, end, frame_radius_mm), color});
    items.push_back({&sphere_, moved(end) * scaled(3, 3, 3), color});
  }
}

/// Arrows are marks, not things: they cast no shadow.
void Scene::addArrow(std::vector<Item>& items, const V& from, const V& to, float radius, const V& color) const {
  constexpr float head_in_radii = 7, head_width_in_radii = 2.6F;
  const float length = (to - from).norm();
  if (length < radius) return;
  const V neck = to + (from - to) * std::min(head_in_radii * radius / length, 0.6F);
  items.push_back({&disc_cylinder_, between(from, neck, radius), color, 1, 0.1F, false});
  items.push_back({&cone_, between(neck, to, head_width_in_radii * radius), color, 1, 0.1F, false});
}

/// Adds an arrow at each end of a muscle. Its length is the muscle's tension at 1 mm per newton, and it points along the muscle, as the
/// muscle pulls there. Arrows stand beside the hose, as seen from the eye, so that the hose does not hide them.
void Scene::addTensions(std::vector<Item>& items, const DrawnHose& hose, const V& eye_mm) const {
  constexpr float beside_in_radii = 1.8F;
  const auto tension_N = static_cast<float>(hose.tension_N);
  if (tension_N < shortest_tension_N) return;
  const float length_mm = std::min(tension_mm_per_N * tension_N, longest_tension_mm);
  std::vector<V> curve = smoothCurve(hose.points_mm);
  for (int end = 0; end < 2; ++end) {
    const V &tip = curve.front(), along = (pointAt(curve, cap_length_in_radii * hose.radius_mm) - tip).stableNormalized();
    const V start = tip + beside_in_radii * hose.radius_mm * along.cross(eye_mm - tip).stableNormalized();
    addArrow(items, start, start + length_mm * along, tension_radius_mm, rgb(tensionColor(hose.tension_N)));
    std::ranges::reverse(curve);
  }
}

/// Two arrows along the normal, one into each body.
void Scene::addContact(std::vector<Item>& items, const DrawnContact& contact) const {
  for (const float sense : {-1.0F, 1.0F})
    addArrow(items, contact.point_mm, contact.point_mm + sense * contact_mm * contact.normal, contact_radius_mm, contact_color);
}

/// A ghost has one colour, and no details of its muscles.
void Scene::addGhost(std::vector<Item>& items, const DrawnGhost& ghost) const {
  const std::size_t first = items.size();
  for (DrawnPart part : ghost.parts) {
    // The length of a capped cylinder does not include its caps.
    if (part.kind == Shape::Kind::box)
      part.size_mm.array() += 2 * ghost_margin_mm;
    else
      part.size_mm.x() += ghost_margin_mm;
    if (part.kind == Shape::Kind::cylinder) part.size_mm.y() += 2 * ghost_margin_mm;
    addPart(items, part, ghost_alpha);
  }
  for (const DrawnHose& hose : ghost.hoses)
    for (std::size_t i = 0; i + 1 < hose.points_mm.size(); ++i)
      items.push_back(
          {&cylinder_, between(hose.points_mm[i], hose.points_mm[i + 1], hose.radius_mm + ghost_margin_mm), V::Zero(), ghost_alpha});
  for (std::size_t i = first; i < items.size(); ++i) {
    items[i].color = ghost_color;
    items[i].has_shadow = false;
  }
}

std::vector<Scene::Item> Scene::itemsOf(const Snapshot& snapshot, const SceneStyle& style, const V& eye_mm) {
  std::vector<Item> items;
  for (std::size_t i = 0; i < snapshot.hoses.size(); ++i) addHose(items, snapshot.hoses[i], i, style);
  for (const DrawnSpring& spring : snapshot.springs)
    for (std::size_t i = 0; i + 1 < spring.points_mm.size(); ++i)
      items.push_back({&cylinder_, between(spring.points_mm[i], spring.points_mm[i + 1], spring.radius_mm), rgb(spring.color)});
  if (style.frames)
    for (const DrawnFrame& frame : snapshot.frames) addFrame(items, frame);
  if (style.arrows) {
    for (const DrawnHose& hose : snapshot.hoses) addTensions(items, hose, eye_mm);
    for (const DrawnContact& contact : snapshot.contacts) addContact(items, contact);
  }
  if (snapshot.pull) addArrow(items, snapshot.pull->point_mm, snapshot.pull->towards_mm, pull_radius_mm, pull_color);
  for (const DrawnPart& part : snapshot.parts) addPart(items, part, style.transparent ? bone_alpha : 1);
  if (style.ghost && snapshot.ghost) addGhost(items, *snapshot.ghost);
  return items;
}

void Scene::drawItem(const Item& item, const M& before) const {
  const M model = before * item.model;
  solid_.set("model", model);
  solid_.set("normal_matrix", Eigen::Matrix3f(item.model.topLeftCorner<3, 3>().inverse().transpose()));
  solid_.set("color", Eigen::Vector4f(item.color.x(), item.color.y(), item.color.z(), item.alpha));
  solid_.set("shine", item.shine);
  item.mesh->draw();
}

/// Draws flat shadows of one colour, then the grid over them.
void Scene::drawFloor(const std::vector<Item>& items, const Camera& camera, float height_mm, float aspect_ratio) const {
  M flat = M::Identity();
  flat(1, 1) = 0;
  flat(1, 3) = height_mm;
  solid_.use();
  solid_.set("lit", 0.0F);
  gl_.Disable(GL_CULL_FACE);  // half of the flattened faces are seen from behind
  for (Item item : items) {
    if (!item.has_shadow) continue;
    item.color = shadow_color;
    item.alpha = 1;
    drawItem(item, flat);
  }
  gl_.Enable(GL_CULL_FACE);
  constexpr float above_mm = 0.5F;
  floor_.use();
  floor_.set("camera", M(camera.projection(aspect_ratio) * camera.view()));
  floor_.set("model",
             M(moved({camera.center_mm.x(), height_mm + above_mm, camera.center_mm.z()}) * scaled(floor_reach_mm, 1, floor_reach_mm)));
  floor_.set("normal_matrix", Eigen::Matrix3f(Eigen::Matrix3f::Identity()));
  floor_.set("center", camera.center_mm);
  floor_.set("spacing", grid_mm);
  floor_.set("reach", floor_reach_mm);
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  square_.draw();
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

/// Draws the target as a sphere; if only its height counts, with a thin disc around it.
void Scene::drawTarget(const DrawnTarget& target) const {
  if (target.is_height) {
    const Item level{&fine_sphere_, moved(target.point_mm) * scaled(level_radius_mm, 0.4F, level_radius_mm), target_color, 0.10F, 0};
    drawItem(level, M::Identity());
  }
  drawItem(
      {&fine_sphere_, moved(target.point_mm) * scaled(target_radius_mm, target_radius_mm, target_radius_mm), target_color, target_alpha},
      M::Identity());
}

void Scene::drawBackground() const {
  gl_.ClearColor(background, background, background, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Scene::draw(const Snapshot& snapshot, const Camera& camera, const SceneStyle& style, const GpuTarget& target) {
  target.bind();
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.Disable(GL_BLEND);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.DepthMask(GL_TRUE);
  drawBackground();
  const float aspect_ratio = static_cast<float>(target.width()) / static_cast<float>(target.height());
  const std::vector<Item> items = itemsOf(snapshot, style, camera.eyeMm());
  const M view = camera.view();
  const Eigen::Matrix3f to_world = view.topLeftCorner<3, 3>().transpose();
  solid_.use();
  solid_.set("camera", M(camera.projection(aspect_ratio) * view));
  solid_.set("eye", camera.eyeMm());
  solid_.set("lamp", V(to_world * V(-0.35F, 0.55F, 0.76F).normalized()));
  if (snapshot.floor_mm) drawFloor(items, camera, *snapshot.floor_mm, aspect_ratio);
  solid_.use();
  solid_.set("lit", 1.0F);
  for (const Item& item : items)
    if (item.alpha == 1) drawItem(item, M::Identity());
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  for (const Item& item : items)
    if (item.alpha < 1) drawItem(item, M::Identity());
  if (snapshot.target) drawTarget(*snapshot.target);
  gl_.Disable(GL_CULL_FACE);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.UseProgram(0);
  target.show();
}

}  // namespace musclesim
