/// Draws snapshots of a simulation with OpenGL.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "../snapshot.h"
#include "camera.h"
#include "gpu.h"

namespace musclesim {

/// Radius of the target's sphere.
inline constexpr float target_radius_mm = 30;

/// How a snapshot is drawn.
struct SceneStyle {
  int selected = -1;           ///< the muscle drawn in red; -1: none
  bool transparent = false;    ///< bones are transparent, so that the muscles behind them are visible
  bool color_tension = false;  ///< muscles have the colour of their tension
  bool frames = false;         ///< show the axes of joints and hand
  bool ghost = true;           ///< show the snapshot's ghost, if it has one
  bool arrows = false;         ///< show tensions at both ends of every muscle, and contacts
};

/// The colour of a tension: dark at 0, then blue, yellow at 100 N and more.
Color tensionColor(double tension_N);

/// Draws in one OpenGL context, which must outlive it.
class Scene {
 public:
  /// Throws SceneError if this OpenGL cannot draw the scene.
  explicit Scene(const Gl& gl);
  ~Scene();

  void draw(const Snapshot& snapshot, const Camera& camera, const SceneStyle& style, const GpuTarget& target);

 private:
  struct Item;
  void drawBackground() const;
  std::vector<Item> itemsOf(const Snapshot& snapshot, const SceneStyle& style, const Eigen::Vector3f& eye_mm);
  void addPart(std::vector<Item>& items, const DrawnPart& part, float alpha) const;
  void addHose(std::vector<Item>& items, const DrawnHose& hose, std::size_t index, const SceneStyle& style);
  void addCap(std::vector<Item>& items, const std::vector<Eigen::Vector3f>& curve, const DrawnHose& hose) const;
  void addFrame(std::vector<Item>& items, const DrawnFrame& frame) const;
  void addArrow(std::vector<Item>& items, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius,
                const Eigen::Vector3f& color) const;
  void addTensions(std::vector<Item>& items, const DrawnHose& hose, const Eigen::Vector3f& eye_mm) const;
  void addContact(std::vector<Item>& items, const DrawnContact& contact) const;
  void addGhost(std::vector<Item>& items, const DrawnGhost& ghost) const;
  void drawItem(const Item& item, const Eigen::Matrix4f& before) const;
  void drawFloor(const std::vector<Item>& items, const Camera& camera, float height_mm, float aspect_ratio) const;
  void drawTarget(const DrawnTarget& target) const;

  const Gl& gl_;
  GpuProgram solid_, floor_;
  GpuMesh box_, sphere_, fine_sphere_, cylinder_, disc_cylinder_, cap_, cone_, square_;
  std::vector<std::unique_ptr<GpuMesh>> tubes_;
};

}  // namespace musclesim
