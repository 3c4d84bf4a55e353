#include "settling.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "equilibrium.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "ode_vector.h"
#include "resting_forces.h"
#include "skeleton.h"

namespace musclesim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double lever_mm = 100;  ///< turns angles into millimetres: about the size of the robots here
constexpr double full_turn_rad = 2 * std::numbers::pi;
constexpr double difference_mm = 1e-6;       ///< of central differences: less than a chain yields in its stop; leaves K seven digits
constexpr double rest_energy_ratio = 1e-22;  ///< of typical force times lever: (1e-11)^2, as the energy is quadratic about its minimum
constexpr double longest_step_mm = 25;       ///< a quarter of the lever: less than the way over which muscles turn their lines around
constexpr double push_back_ratio = 0.5;      ///< at 1 the energy along a step of constant stiffness would stay the same
constexpr double still_pushing_ratio = 0.5;  ///< of the push along a step: Newton's step would leave none
constexpr double soft_ratio = 1e-9;          ///< stiffness added where there is none, above the rounding of central differences
constexpr double least_stiffness_N_per_mm = 1e-100;  ///< not 0 where nothing acts
constexpr double first_levenberg_ratio = 1e-3;       ///< of the stiffness; then four times more until it suffices
constexpr int step_limit = 500;                      ///< some ten suffice; ways of metres take a hundred
constexpr int halving_limit = 40;
constexpr double stop_accuracy_mm = 1e-9;  ///< of the length of a chain at its stop: its beads' positions have about that many digits
constexpr int correction_limit = 40;       ///< some five suffice

class Settling {
 public:
  explicit Settling(World& world) : skeleton_(world), forces_(world, skeleton_) {
    const auto count = static_cast<Eigen::Index>(coordinates().size());
    force_ = force_there_ = VectorXd::Zero(count);
    scale_.resize(count);
    built_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Coordinate& coordinate = at(i);
      scale_[i] = coordinate.turns ? 1 / lever_mm : 1;
      built_[i] = std::clamp(0.0, std::min(coordinate.low, coordinate.high), std::max(coordinate.low, coordinate.high));
      if (!coordinate.locked()) movable_.push_back(i);
    }
  }

  void place() {
    VectorXd q = built_;
    forces_.at(q, force_);
    forces_.requireChainsFit();
    RestingForces::Beyond before = {nullptr, dInfinity};
    for (int i = 0; i < correction_limit; ++i) {
      q = movable_.size() == 1 ? restOfOne() : restOfSeveral(q);
      forces_.at(q, force_);
      const RestingForces::Beyond beyond = forces_.correctStops();
      if (beyond.by_mm <= stop_accuracy_mm) return forces_.layMuscles();
      if (beyond.by_mm > before.by_mm / 4) forces_.stiffenStops(10);  // the rest of the robot is as stiff as the stops
      before = beyond;
    }
    throw BadParameter(fmt::format("{} stays {:.3g} mm beyond the range of its links", before.muscle->name(), before.by_mm));
  }

 private:
  const std::vector<Coordinate>& coordinates() const { return skeleton_.coordinates(); }
  const Coordinate& at(Eigen::Index i) const { return coordinates()[static_cast<std::size_t>(i)]; }

  /// Shortens a step that would lead beyond a stop.
  void endAtStops(const VectorXd& q, VectorXd& step) const {
    double share = 1;
    for (const Eigen::Index i : movable_) {
      const double way = (step[i] < 0 ? at(i).low : at(i).high) - q[i];
      if (std::abs(share * step[i]) > std::abs(way)) share = way / step[i];
    }
    step *= share;
  }

  /// Coordinates after a step that ends at stops; rounding does not lead beyond them.
  VectorXd moved(const VectorXd& q, const VectorXd& step) const {
    VectorXd there = skeleton_.displaced(q, step);
    for (const Eigen::Index i : movable_) there[i] = std::clamp(there[i], at(i).low, at(i).high);
    return there;
  }

  VectorXd restOfOne() {
    const Eigen::Index i = movable_.front();
    const Coordinate& coordinate = at(i);
    VectorXd q = built_;
    const auto back = [&](double value) {
      q[i] = value;
      forces_.at(q, force_);
      return -force_[i];
    };
    // Without stops, all poses of a hinge lie within one turn.
    const double way = coordinate.turns ? full_turn_rad : dInfinity;
    q[i] = restFrom(back, built_[i], std::max(coordinate.low, -way), std::min(coordinate.high, way));
    const bool at_stop = q[i] == coordinate.low || q[i] == coordinate.high;
    if (!std::isfinite(q[i]) || (!at_stop && std::abs(q[i]) == way)) throwUnbalanced(q);
    return q;
  }

  VectorXd restOfSeveral(VectorXd q) {
    double stretch = 1;  // steps that added stiffness has made too short grow until they have an effect
    forces_.at(q, force_);
    for (int i = 0; i < step_limit; ++i) {
      VectorXd step = newtonStep(q);
      if (force_.dot(step) <= rest_energy_ratio * forces_.typicalForceN() * lever_mm) return moved(q, step);
      step *= stretch;
      const double length_mm = step.cwiseQuotient(scale_).norm();
      if (length_mm > longest_step_mm) step *= longest_step_mm / length_mm;
      endAtStops(q, step);
      const std::optional<double> left = goDownhill(q, step);
      if (!left) break;
      stretch = *left > still_pushing_ratio ? 2 * stretch : 1;
    }
    throwUnbalanced(q);
  }

  /// Goes the step, or a half, a quarter, ... of it. Returns which share of the push along it is left at its end; nothing where the forces
  /// push back even after the shortest.
  std::optional<double> goDownhill(VectorXd& q, VectorXd step) {
    for (int i = 0; i < halving_limit; ++i, step /= 2) {
      const VectorXd there = moved(q, step);
      forces_.at(there, force_there_);
      const double push = force_.dot(step), push_there = force_there_.dot(step);
      if (!(push > 0 && push_there >= -push_back_ratio * push)) continue;
      q = there;
      force_ = force_there_;
      return push_there / push;
    }
    return std::nullopt;
  }

  bool pressesIntoStop(Eigen::Index i, double position, double push) const {
    return (position <= at(i).low && push < 0) || (position >= at(i).high && push > 0);
  }

  /// The coordinates that do not rest at a stop.
  std::vector<Eigen::Index> freeAt(const VectorXd& q) const {
    std::vector<Eigen::Index> free;
    for (const Eigen::Index i : movable_)
      if (!pressesIntoStop(i, q[i], force_[i])) free.push_back(i);
    return free;
  }

  VectorXd newtonStep(const VectorXd& q) {
    std::vector<Eigen::Index> free = freeAt(q);
    const MatrixXd stiffness = stiffnessAt(q, free);
    while (true) {
      const VectorXd step = stepOf(free, stiffness);
      if (std::erase_if(free, [&](Eigen::Index i) { return pressesIntoStop(i, q[i], step[i]); }) == 0) return step;
    }
  }

  /// (K + mu) d = Q of the free coordinates; the others stay.
  VectorXd stepOf(const std::vector<Eigen::Index>& free, const MatrixXd& stiffness) const {
    const auto count = static_cast<Eigen::Index>(free.size());
    VectorXd step = VectorXd::Zero(force_.size()), push(count);
    MatrixXd own(count, count);
    for (Eigen::Index row = 0; row < count; ++row) {
      const Eigen::Index i = free[static_cast<std::size_t>(row)];
      push[row] = force_[i] * scale_[i];
      for (Eigen::Index column = 0; column < count; ++column) own(row, column) = stiffness(i, free[static_cast<std::size_t>(column)]);
    }
    const VectorXd solution = definiteSolution(own, push);
    for (Eigen::Index row = 0; row < count; ++row) {
      const Eigen::Index i = free[static_cast<std::size_t>(row)];
      step[i] = solution[row] * scale_[i];
    }
    return step;
  }

  /// The symmetric part of -dQ/dq in N/mm, with the rows and columns of the free coordinates.
  MatrixXd stiffnessAt(const VectorXd& q, const std::vector<Eigen::Index>& free) {
    MatrixXd stiffness = MatrixXd::Zero(q.size(), q.size());
    VectorXd behind = force_, ahead = force_, step = VectorXd::Zero(q.size());
    for (const Eigen::Index i : free) {
      step[i] = difference_mm * scale_[i];
      forces_.at(skeleton_.displaced(q, step), ahead);
      forces_.at(skeleton_.displaced(q, -step), behind);
      stiffness.col(i) = (behind - ahead).cwiseProduct(scale_) / (2 * difference_mm);
      step[i] = 0;
    }
    return (stiffness + stiffness.transpose()) / 2;
  }

  VectorXd definiteSolution(const MatrixXd& stiffness, const VectorXd& force) const {
    if (force.size() == 0) return force;
    const double size = stiffness.diagonal().cwiseAbs().maxCoeff() + forces_.typicalForceN() / lever_mm + least_stiffness_N_per_mm;
    double added = soft_ratio * size;
    while (true) {
      const Eigen::LLT<MatrixXd> factor(stiffness + added * MatrixXd::Identity(stiffness.rows(), stiffness.cols()));
      if (factor.info() == Eigen::Success) return factor.solve(force);
      added = std::max(4 * added, first_levenberg_ratio * size);
    }
  }

  [[noreturn]] void throwUnbalanced(const VectorXd& q) const {
    const auto size = [&](Eigen::Index i) { return pressesIntoStop(i, q[i], force_[i]) ? 0 : std::abs(force_[i] * scale_[i]); };
    const Eigen::Index worst = *std::ranges::max_element(movable_, {}, size);
    const Coordinate& coordinate = at(worst);
    throw BadParameter(
        fmt::format("no equilibrium is found on the way from the pose as "
                    "built; the last pose is pushed out of balance by "
                    "{:.3g} {} at {}",
                    coordinate.turns ? force_[worst] / mm_per_m : force_[worst], coordinate.turns ? "N m" : "N", coordinate.name()));
  }

  Skeleton skeleton_;
  RestingForces forces_;
  std::vector<Eigen::Index> movable_;  ///< coordinates without those that are locked
  VectorXd built_;                     ///< the pose as built, within the stops
  VectorXd scale_;                     ///< displacement of a coordinate that counts as 1 mm
  VectorXd force_, force_there_;       ///< on the coordinates: in the present pose, and at the end of a step
};

/// Where the bodies are before they settle.
class Poses {
 public:
  explicit Poses(const World& world) {
    for (const auto& body : world.bodies()) poses_.push_back({body->id, positionOf(body->id), rotationOf(body->id)});
  }
  void restore() const {
    for (const Pose& pose : poses_) {
      dBodySetPosition(pose.body, pose.position.x(), pose.position.y(), pose.position.z());
      setRotation(pose.body, pose.rotation);
    }
  }

 private:
  struct Pose {
    dBodyID body;
    Vector position;
    Eigen::Matrix3d rotation;
  };
  std::vector<Pose> poses_;
};

/// Bodies that settle do not move; effects may depend on their speed.
void stopBodies(const World& world) {
  for (const auto& body : world.bodies()) {
    dBodySetLinearVel(body->id, 0, 0, 0);
    dBodySetAngularVel(body->id, 0, 0, 0);
  }
}

}  // namespace

void placeAtRest(World& world) {
  const Poses before(world);
  stopBodies(world);
  try {
    Settling(world).place();
  } catch (const BadParameter& why) {
    before.restore();
    throw BadParameter(fmt::format("initial_state = settled: {}; use built (--initial-state built)", why.what()));
  }
}

}  // namespace musclesim
