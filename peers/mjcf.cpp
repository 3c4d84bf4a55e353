#include "mjcf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace musclesim::peers {

namespace {

std::string text(const Vector& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}
std::string text(const Eigen::Quaterniond& q) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

/// A rotation that takes the z axis to a direction of unit length.
Eigen::Quaterniond zTurnedTo(const Vector& direction) {
  Eigen::Matrix3d columns;
  columns.col(0) = direction.unitOrthogonal();
  columns.col(1) = direction.cross(columns.col(0));
  columns.col(2) = direction;
  return Eigen::Quaterniond(columns);
}

/// In this time a joint that has been pressed into its stop leaves it: physics.stop_time_constant_s.
constexpr double stop_time_constant_s = 2e-3;

class Writer {
 public:
  Writer(const Mechanism& mechanism, const Tree& tree, const MjcfOptions& options) : mechanism_(mechanism), tree_(tree), options_(options) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) children_[tree.nodes[i].parent].push_back(i);
    for (std::size_t m = 0; m < mechanism.muscles.size(); ++m) collectSites(m);
  }

  std::string document() {
    out_ = "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>";
    out_ += fmt::format("<option timestep=\"{:.17g}\" integrator=\"{}\" solver=\"{}\" gravity=\"0 {:.17g} 0\"/>", options_.step_s,
                        options_.integrator, options_.solver, -mechanism_.gravity_m_per_s2);
    const double shortest_s = 2 * options_.step_s;
    const double damping_ratio = std::max(1.0, std::sqrt(stop_time_constant_s / (2 * shortest_s)));
    out_ += fmt::format(
        "<default><joint solreflimit=\"{0:.17g} {1:.17g}\" solreffriction=\"{0:.17g} 1\"{2}/><equality solref=\"{0:.17g} 1\"/></default>",
        shortest_s, damping_ratio, options_.hard_stops ? " solimplimit=\"0.999 0.9999 0.001\"" : "");
    out_ += "<worldbody>";
    writeSites(environment);
    for (const std::size_t node : children_[environment]) writeBody(node);
    out_ += "</worldbody>";
    writeLoops();
    writeLines();
    return out_ + "</mujoco>";
  }

 private:
  void collectSites(std::size_t m) {
    const MuscleParts& muscle = mechanism_.muscles[m];
    for (std::size_t i = 0; i < muscle.points.size(); ++i)
      sites_[muscle.points[i].body] +=
          fmt::format("<site name=\"m{}_{}\" pos=\"{}\" size=\"0.001\"/>", m, i, text(muscle.points[i].place_m));
    for (std::size_t i = 0; i < muscle.pulleys.size(); ++i) {
      if (!muscle.pulleys[i]) continue;
      const WrappingPulley& pulley = *muscle.pulleys[i];
      const bool sphere = pulley.axis.isZero(0);
      const Eigen::Quaterniond turn = sphere ? Eigen::Quaterniond::Identity() : zTurnedTo(pulley.axis);
      sites_[pulley.center.body] += fmt::format(
          "<geom name=\"m{}_{}_pulley\" type=\"{}\" size=\"{:.17g}{}\" pos=\"{}\" quat=\"{}\" contype=\"0\" conaffinity=\"0\"/>", m, i,
          sphere ? "sphere" : "cylinder", pulley.radius_m, sphere ? "" : " 0.1", text(pulley.center.place_m), text(turn));
      if (pulley.side_m)
        sites_[pulley.center.body] += fmt::format("<site name=\"m{}_{}_side\" pos=\"{}\" size=\"0.001\"/>", m, i, text(*pulley.side_m));
    }
  }
  void writeSites(int body) {
    if (const auto found = sites_.find(body); found != sites_.end()) out_ += found->second;
  }

  void writeBody(std::size_t n) {
    const TreeNode& node = tree_.nodes[n];
    const RigidBody& body = mechanism_.bodies[static_cast<std::size_t>(node.body)];
    Vector position = body.position_m;
    Eigen::Quaterniond rotation = body.rotation;
    if (node.parent != environment) {
      const RigidBody& parent = mechanism_.bodies[static_cast<std::size_t>(node.parent)];
      position = parent.rotation.conjugate() * (body.position_m - parent.position_m);
      rotation = parent.rotation.conjugate() * body.rotation;
    }
    out_ += fmt::format("<body name=\"b{}\" pos=\"{}\" quat=\"{}\">", node.body, text(position), text(rotation));
    const Eigen::Matrix3d& I = body.inertia_kg_m2;
    out_ += fmt::format("<inertial pos=\"0 0 0\" mass=\"{:.17g}\" fullinertia=\"{} {:.17g} {:.17g} {:.17g}\"/>", body.mass_kg,
                        text(Vector(I.diagonal())), I(0, 1), I(0, 2), I(1, 2));
    writeJoint(node, body);
    writeSites(node.body);
    for (const std::size_t child : children_[node.body]) writeBody(child);
    out_ += "</body>";
  }

  void writeJoint(const TreeNode& node, const RigidBody& body) {
    if (node.joint < 0) {
      out_ += "<freejoint/>";
      return;
    }
    const BodyJoint& joint = mechanism_.joints[static_cast<std::size_t>(node.joint)];
    const std::string place = text(Vector(body.rotation.conjugate() * (joint.anchor_m - body.position_m)));
    if (joint.kind == Joint::Kind::ball) out_ += fmt::format("<joint name=\"j{}\" type=\"ball\" pos=\"{}\"/>", node.joint, place);
    // Of several joints of a body the first is fixed to its parent.
    const bool second_first = joint.axes.size() == 2 && !node.reversed;
    for (std::size_t i = 0; i < joint.axes.size(); ++i) {
      const std::size_t which = second_first ? joint.axes.size() - 1 - i : i;
      const JointAxis& axis = joint.axes[which];
      const Vector direction = body.rotation.conjugate() * (node.reversed ? Vector(-axis.direction) : axis.direction);
      const bool limited = std::isfinite(axis.low) || std::isfinite(axis.high);
      constexpr double far = 1e6;
      out_ += fmt::format("<joint name=\"j{}{}\" type=\"{}\" pos=\"{}\" axis=\"{}\" frictionloss=\"{:.17g}\" damping=\"{:.17g}\"",
                          node.joint, which == 1 ? "_2" : "", joint.kind == Joint::Kind::slider ? "slide" : "hinge", place, text(direction),
                          axis.friction, axis.damping);
      // MuJoCo refuses a range without width, and begins its stops where they are crossed.
      if (limited) out_ += fmt::format(" limited=\"true\" range=\"{:.17g} {:.17g}\"", std::max(-far, axis.low), std::min(far, axis.high));
      out_ += "/>";
    }
  }

  void writeLoops() {
    out_ += "<equality>";
    for (const int loop : tree_.loops) {
      const BodyJoint& joint = mechanism_.joints[static_cast<std::size_t>(loop)];
      const RigidBody& first = mechanism_.bodies[static_cast<std::size_t>(joint.first)];
      const std::string second = joint.second == environment ? "" : fmt::format(" body2=\"b{}\"", joint.second);
      out_ += fmt::format("<connect body1=\"b{}\"{} anchor=\"{}\"/>", joint.first, second,
                          text(Vector(first.rotation.conjugate() * (joint.anchor_m - first.position_m))));
    }
    out_ += "</equality>";
  }

  void writeLines() {
    std::string tendons, motors;
    for (std::size_t m = 0; m < mechanism_.muscles.size(); ++m) {
      const MuscleParts& muscle = mechanism_.muscles[m];
      if (muscle.points.empty()) continue;
      tendons += fmt::format("<spatial name=\"m{}\">", m);
      for (std::size_t i = 0; i < muscle.points.size(); ++i) {
        tendons += fmt::format("<site site=\"m{}_{}\"/>", m, i);
        if (i >= muscle.pulleys.size() || !muscle.pulleys[i]) continue;
        const std::string side = muscle.pulleys[i]->side_m ? fmt::format(" sidesite=\"m{}_{}_side\"", m, i) : "";
        tendons += fmt::format("<geom geom=\"m{}_{}_pulley\"{}/>", m, i, side);
      }
      tendons += "</spatial>";
      motors += fmt::format("<motor name=\"m{0}\" tendon=\"m{0}\"/>", m);
    }
    if (!tendons.empty()) out_ += "<tendon>" + tendons + "</tendon><actuator>" + motors + "</actuator>";
  }

  const Mechanism& mechanism_;
  const Tree& tree_;
  const MjcfOptions& options_;
  std::map<int, std::vector<std::size_t>> children_;
  std::map<int, std::string> sites_;
  std::string out_;
};

}  // namespace

std::string mjcfOf(const Mechanism& mechanism, const Tree& tree, const MjcfOptions& options) {
  return Writer(mechanism, tree, options).document();
}

}  // namespace musclesim::peers
