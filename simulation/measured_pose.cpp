#include "measured_pose.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "../robot/skeleton.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double lever_mm = 100;           ///< makes lengths of angles
constexpr double difference_mm = 1e-3;     ///< of central differences
constexpr double expansion_step_mm = 0.1;  ///< large enough for second differences
constexpr double aside_mm = 10;            ///< from the pose as built, where symmetry can hide that a reading depends on a coordinate
constexpr double rank_ratio = 1e-3;        ///< a coordinate that moves readings by less than this share counts as not determined
constexpr double arrived_mm = 1e-5;        ///< of a step
constexpr double longest_step_mm = 25;     ///< so that the search does not leap to another pose with similar readings
constexpr double first_damping = 1e-6;     ///< of the largest curvature
constexpr double most_damping = 1e6;
constexpr int step_limit = 100;

/// The last value of a signal up to a row; before the first one, that.
double valueAt(const std::vector<double>& values, std::size_t row) {
  for (std::size_t i = std::min(row + 1, values.size()); i-- > 0;)
    if (std::isfinite(values[i])) return values[i];
  return *std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
}

/// A signal of the recording with readings; null if there is none.
const Signal* measured(const Recording& recording, const std::string& name) {
  const Signal* signal = recording.find(name);
  return signal && std::ranges::any_of(signal->values, [](double value) { return std::isfinite(value); }) ? signal : nullptr;
}

/// How much longer a muscle is than the distance of its ends.
double excessMm(const DrawnHose& hose) {
  return hose.length_mm - (hose.points_mm.back() - hose.points_mm.front()).cast<double>().norm();
}

}  // namespace

class MeasuredPoses::Search {
 public:
  Search(const Recording& recording, const ReplayOptions& options);

  const std::string& sources() const { return sources_; }
  const std::string& fault() const { return fault_; }
  std::shared_ptr<const DrawnGhost> at(std::size_t row, const Snapshot& simulated);
  std::optional<MotionExpansion> expansion(std::size_t row, const std::vector<std::string>& signals);

 private:
  /// A length of a muscle, a coordinate of the hand, or a distance of two bones at a closure, in the pose of the bodies.
  struct Reading {
    const Signal* signal;  ///< null: it is 0
    std::function<double()> value_mm;
  };
  struct GivenAngle {
    const Signal* signal;
    Index coordinate;
  };

  static SimulationOptions modelOf(const Recording& recording, const ReplayOptions& options);
  static std::string robotOf(const Recording& recording, const ReplayOptions& options);
  void takeAngles(const Recording& recording);
  void closeLoops();
  void takeLengths(const Recording& recording);
  void takeHand(const Recording& recording);
  double lengthMm(const Actuator& muscle) const;
  void addSource(const std::string& source) { sources_ += (sources_.empty() ? "from " : " and ") + source; }
  bool determined();
  std::pair<Vector, Vector> endsOf(const Actuator& muscle) const;
  void pose(const VectorXd& q);
  VectorXd readingsAt(const VectorXd& q);
  VectorXd moved(const VectorXd& q, const VectorXd& step_mm) const;
  MatrixXd slopeAt(const VectorXd& q);
  void fit(const VectorXd& measured_mm);
  void locate(std::size_t row);
  std::function<double()> motionNamed(const std::string& signal);

  Simulation simulation_;
  std::optional<SnapshotTaker> snapshots_;
  std::optional<Skeleton> skeleton_;
  std::vector<GivenAngle> angles_;
  std::vector<Reading> readings_;
  std::vector<double> excess_mm_;  ///< of the muscles' lengths over the distances of their ends
  std::vector<Index> unknown_;     ///< coordinates that follow from the readings
  VectorXd scale_;                 ///< coordinate per mm
  VectorXd q_;                     ///< the pose found last
  VectorXd posed_;                 ///< the pose of the bodies
  std::string sources_, fault_;
};

SimulationOptions MeasuredPoses::Search::modelOf(const Recording& recording, const ReplayOptions& options) {
  RecordingInfo info = recording.info;
  replaceRobot(info, options.robot);
  ReplayOptions clean = options;
  clean.effects.clear();
  return simulationOptionsFor(info, sidecarPath(recording.file), clean);
}

std::string MeasuredPoses::Search::robotOf(const Recording& recording, const ReplayOptions& options) {
  return options.robot.value_or(recording.info.robot);
}

MeasuredPoses::Search::Search(const Recording& recording, const ReplayOptions& options) : simulation_(modelOf(recording, options)) {
  Robot& robot = simulation_.build(robotOf(recording, options));
  simulation_.start("built", musclesim::Action(static_cast<std::size_t>(robot.actuatorCount()), 0.0));
  for (Actuator* muscle : robot.actuators()) muscle->finishPath();
  snapshots_.emplace(simulation_);
  try {
    skeleton_.emplace(simulation_.world(), Skeleton::Loops::opened);
  } catch (const BadParameter& error) {
    fault_ = error.what();
    return;
  }
  takeAngles(recording);
  closeLoops();
  if (!determined()) takeLengths(recording);
  if (!determined()) takeHand(recording);
  if (determined()) return;
  fault_ = sources_.empty() ? "neither joint angles nor muscle lengths nor the hand's position are measured"
                            : "what is measured does not determine every joint";
}

void MeasuredPoses::Search::takeAngles(const Recording& recording) {
  const std::vector<Coordinate>& coordinates = skeleton_->coordinates();
  q_ = VectorXd::Zero(static_cast<Index>(coordinates.size()));
  scale_ = VectorXd::Ones(q_.size());
  for (Index i = 0; i < q_.size(); ++i) {
    const Coordinate& coordinate = coordinates[static_cast<std::size_t>(i)];
    if (coordinate.turns) scale_[i] = 1 / lever_mm;
    const auto& reported = simulation_.robot().angles();
    const auto angle = std::ranges::find_if(
        reported, [&](const Robot::Angle& one) { return one.joint == coordinate.joint && one.axis == coordinate.axis; });
    const Signal* signal = angle == reported.end() ? nullptr : measured(recording, "angle_" + angle->name + "_deg");
    if (signal)
      angles_.push_back({signal, i});
    else if (!coordinate.locked())
      unknown_.push_back(i);
  }
  if (!angles_.empty()) addSource("the joint angles");
}

void MeasuredPoses::Search::closeLoops() {
  for (const Joint* joint : skeleton_->closures())
    for (int axis = 0; axis < 3; ++axis)
      readings_.push_back({nullptr, [this, joint, axis] {
                             const auto on = [&](int which) {
                               return skeleton_->pointMm(skeleton_->numberOf(dJointGetBody(joint->id(), which)),
                                                         joint->reference().anchor[which]);
                             };
                             return on(0)[axis] - on(1)[axis];
                           }});
}

/// The path of a line muscle; of a chain the distance of its ends.
double MeasuredPoses::Search::lengthMm(const Actuator& muscle) const {
  if (muscle.line()) return muscle.lengthMm();
  const auto [start, end] = endsOf(muscle);
  return (end - start).norm();
}

void MeasuredPoses::Search::takeLengths(const Recording& recording) {
  const auto& muscles = simulation_.robot().actuators();
  const std::size_t before = readings_.size();
  excess_mm_.assign(muscles.size(), 0);
  for (std::size_t i = 0; i < muscles.size(); ++i)
    if (const Signal* signal = measured(recording, fmt::format("length_{}_mm", i)))
      readings_.push_back({signal, [this, i, &muscle = *muscles[i]] { return lengthMm(muscle) + excess_mm_[i]; }});
  if (readings_.size() > before) addSource("the muscle lengths");
}

void MeasuredPoses::Search::takeHand(const Recording& recording) {
  const Robot& robot = simulation_.robot();
  const std::size_t before = readings_.size();
  for (int axis = 0; axis < 3 && robot.hand(); ++axis)
    if (const Signal* signal = measured(recording, fmt::format("hand_{}_mm", "xyz"[axis])))
      readings_.push_back({signal, [&robot, axis] { return robot.handMm()[axis]; }});
  if (readings_.size() > before) addSource("the hand's position");
}

/// Whether the readings depend on every unknown coordinate, each in its own way.
bool MeasuredPoses::Search::determined() {
  if (unknown_.empty()) return true;
  if (readings_.size() < unknown_.size()) return false;
  VectorXd aside(static_cast<Index>(unknown_.size()));
  for (Index i = 0; i < aside.size(); ++i) aside[i] = aside_mm / static_cast<double>(i + 1);
  Eigen::ColPivHouseholderQR<MatrixXd> slope(slopeAt(moved(VectorXd::Zero(q_.size()), aside)));
  slope.setThreshold(rank_ratio);
  return slope.rank() == aside.size();
}

std::pair<Vector, Vector> MeasuredPoses::Search::endsOf(const Actuator& muscle) const {
  const auto pointOf = [this](const Joint& joint) {
    return skeleton_->pointMm(skeleton_->numberOf(dJointGetBody(joint.id(), 1)), joint.reference().anchor[1]);
  };
  return {pointOf(*muscle.startJoint()), pointOf(*muscle.endJoint())};
}

void MeasuredPoses::Search::pose(const VectorXd& q) {
  posed_ = q;
  skeleton_->setPose(q);
  skeleton_->placeBodies();
}

/// All readings in a pose.
VectorXd MeasuredPoses::Search::readingsAt(const VectorXd& q) {
  pose(q);
  VectorXd values(static_cast<Index>(readings_.size()));
  for (Index i = 0; i < values.size(); ++i) values[i] = readings_[static_cast<std::size_t>(i)].value_mm();
  return values;
}

/// Moves the unknown coordinates.
VectorXd MeasuredPoses::Search::moved(const VectorXd& q, const VectorXd& step_mm) const {
  VectorXd by = VectorXd::Zero(q.size());
  for (std::size_t i = 0; i < unknown_.size(); ++i) by[unknown_[i]] = scale_[unknown_[i]] * step_mm[static_cast<Index>(i)];
  return skeleton_->displaced(q, by);
}

/// Derivatives of the readings by the unknown coordinates, mm per mm.
MatrixXd MeasuredPoses::Search::slopeAt(const VectorXd& q) {
  const auto count = static_cast<Index>(unknown_.size());
  MatrixXd slope(static_cast<Index>(readings_.size()), count);
  for (Index i = 0; i < count; ++i) {
    const VectorXd step = difference_mm * VectorXd::Unit(count, i);
    slope.col(i) = (readingsAt(moved(q, step)) - readingsAt(moved(q, -step))) / (2 * difference_mm);
  }
  return slope;
}

void MeasuredPoses::Search::fit(const VectorXd& measured_mm) {
  VectorXd error = measured_mm - readingsAt(q_);
  double damping = first_damping;
  for (int i = 0; i < step_limit; ++i) {
    const MatrixXd slope = slopeAt(q_);
    MatrixXd normal = slope.transpose() * slope;
    const double largest = normal.diagonal().maxCoeff();
    for (bool better = false; !better; better ? damping /= 10 : damping *= 10) {
      if (damping > most_damping) return;
      const MatrixXd damped = normal + damping * largest * MatrixXd::Identity(normal.rows(), normal.cols());
      VectorXd step = damped.ldlt().solve(slope.transpose() * error);
      if (step.norm() > longest_step_mm) step *= longest_step_mm / step.norm();
      const VectorXd there = moved(q_, step), error_there = measured_mm - readingsAt(there);
      if (step.norm() < arrived_mm) return;
      better = error_there.squaredNorm() < error.squaredNorm();
      if (!better) continue;
      q_ = there;
      error = error_there;
    }
    damping = std::max(damping, first_damping);
  }
}

/// Finds the coordinates in a row.
void MeasuredPoses::Search::locate(std::size_t row) {
  for (const GivenAngle& angle : angles_) q_[angle.coordinate] = valueAt(angle.signal->values, row) * rad_per_deg;
  if (unknown_.empty()) return;
  VectorXd measured_mm(static_cast<Index>(readings_.size()));
  for (Index i = 0; i < measured_mm.size(); ++i) {
    const Signal* signal = readings_[static_cast<std::size_t>(i)].signal;
    measured_mm[i] = signal ? valueAt(signal->values, row) : 0;
  }
  fit(measured_mm);
}

std::shared_ptr<const DrawnGhost> MeasuredPoses::Search::at(std::size_t row, const Snapshot& simulated) {
  const auto& chains = simulation_.robot().actuators();
  for (std::size_t i = 0; i < excess_mm_.size(); ++i) excess_mm_[i] = chains[i]->line() ? 0 : excessMm(simulated.hoses[i]);
  locate(row);
  pose(q_);
  Snapshot snapshot = snapshots_->take(State{});
  const auto& muscles = simulation_.robot().actuators();
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    if (muscles[i]->line()) continue;
    const auto [start, end] = endsOf(*muscles[i]);
    snapshot.hoses[i].points_mm = {start.cast<float>(), end.cast<float>()};
  }
  return std::make_shared<const DrawnGhost>(DrawnGhost{std::move(snapshot.parts), std::move(snapshot.hoses)});
}

/// The value of a signal of motion in the pose of the bodies; empty for any other signal.
std::function<double()> MeasuredPoses::Search::motionNamed(const std::string& signal) {
  const Robot& robot = simulation_.robot();
  for (const Robot::Angle& angle : robot.angles())
    if (signal == "angle_" + angle.name + "_deg")
      for (Index i = 0; i < q_.size(); ++i) {
        const Coordinate& coordinate = skeleton_->coordinates()[static_cast<std::size_t>(i)];
        if (coordinate.joint == angle.joint && coordinate.axis == angle.axis) return [this, i] { return posed_[i] / rad_per_deg; };
      }
  const auto& muscles = robot.actuators();
  for (std::size_t i = 0; i < muscles.size(); ++i)
    if (signal == fmt::format("length_{}_mm", i)) return [this, &muscle = *muscles[i]] { return lengthMm(muscle); };
  for (int axis = 0; axis < 3 && robot.hand(); ++axis)
    if (signal == fmt::format("hand_{}_mm", "xyz"[axis])) return [&robot, axis] { return robot.handMm()[axis]; };
  return {};
}

std::optional<MotionExpansion> MeasuredPoses::Search::expansion(std::size_t row, const std::vector<std::string>& signals) {
  std::vector<std::function<double()>> values;
  for (const std::string& signal : signals) values.push_back(motionNamed(signal));
  const bool all_known = std::ranges::all_of(values, [](const auto& value) { return static_cast<bool>(value); });
  if (!skeleton_->closures().empty() || !all_known) return std::nullopt;
  locate(row);
  std::vector<VectorXd> steps;
  for (Index i = 0; i < q_.size(); ++i)
    if (!skeleton_->coordinates()[static_cast<std::size_t>(i)].locked())
      steps.emplace_back(scale_[i] * expansion_step_mm * VectorXd::Unit(q_.size(), i));
  const auto beyond = [&](const VectorXd& step) {
    pose(skeleton_->displaced(q_, step));
    VectorXd at(static_cast<Index>(values.size()));
    for (Index s = 0; s < at.size(); ++s) at[s] = values[static_cast<std::size_t>(s)]();
    return at;
  };
  const auto count = static_cast<Index>(steps.size());
  const VectorXd here = beyond(VectorXd::Zero(q_.size()));
  MotionExpansion result{MatrixXd(here.size(), count), std::vector<MatrixXd>(values.size(), MatrixXd(count, count))};
  std::vector<VectorXd> ahead;
  for (Index i = 0; i < count; ++i) {
    const VectorXd& step = steps[static_cast<std::size_t>(i)];
    ahead.push_back(beyond(step));
    const VectorXd behind = beyond(-step);
    result.slope.col(i) = (ahead.back() - behind) / (2 * expansion_step_mm);
    for (Index k = 0; k <= i; ++k) {
      const VectorXd difference =
          k == i ? VectorXd(ahead.back() - 2 * here + behind)
                 : VectorXd(beyond(step + steps[static_cast<std::size_t>(k)]) - ahead.back() - ahead[static_cast<std::size_t>(k)] + here);
      for (Index s = 0; s < here.size(); ++s)
        result.bend[static_cast<std::size_t>(s)](i, k) = result.bend[static_cast<std::size_t>(s)](k, i) =
            difference[s] / (expansion_step_mm * expansion_step_mm);
    }
  }
  return result;
}

MeasuredPoses::MeasuredPoses(const Recording& recording, const ReplayOptions& options)
    : search_(std::make_unique<Search>(recording, options)), reason_(search_->fault().empty() ? search_->sources() : search_->fault()) {}

MeasuredPoses::~MeasuredPoses() = default;

bool MeasuredPoses::areDetermined() const {
  return search_->fault().empty();
}

const std::string& MeasuredPoses::reason() const {
  return reason_;
}

std::optional<MotionExpansion> MeasuredPoses::expansion(std::size_t row, const std::vector<std::string>& signals) {
  return areDetermined() ? search_->expansion(row, signals) : std::nullopt;
}

std::shared_ptr<const DrawnGhost> MeasuredPoses::at(std::size_t row, const Snapshot& simulated) {
  return areDetermined() ? search_->at(row, simulated) : nullptr;
}

}  // namespace musclesim
