#include "parity.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "../../simulation/measured_pose.h"

namespace musclesim {

namespace {

/// A coordinate that moves the readings by less than this share of what another one does is not seen by them.
constexpr double rank_ratio = 1e-3;
constexpr double straight_mm = 5;  ///< D; 0.05 rad: within about 3 degrees, signals are taken as straight

}  // namespace

bool isMotion(const std::string& signal) {
  return signal.starts_with("angle_") || signal.starts_with("length_") || signal.starts_with("hand_");
}

ParityRelations::ParityRelations(const Recording& recording, const ReplayOptions& model, std::vector<int> signals,
                                 const std::vector<std::string>& names, const std::vector<double>& sigmas)
    : signals_(std::move(signals)) {
  if (signals_.size() < 2) return;
  std::vector<std::string> own_names;
  Eigen::VectorXd sigma(static_cast<Eigen::Index>(signals_.size()));
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    own_names.push_back(names[static_cast<std::size_t>(signals_[i])]);
    sigma[static_cast<Eigen::Index>(i)] = sigmas[static_cast<std::size_t>(signals_[i])];
  }
  MeasuredPoses poses(recording, model);
  Eigen::Index largest_rank = 0;
  for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
    std::optional<MotionExpansion> near = poses.expansion(row, own_names);
    if (!near || !near->slope.allFinite()) {
      rows_.clear();
      return;
    }
    Eigen::VectorXd scale = sigma;
    for (Eigen::Index i = 0; i < scale.size(); ++i)
      scale[i] = std::hypot(sigma[i], 0.5 * straight_mm * straight_mm * near->bend[static_cast<std::size_t>(i)].norm());
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(scale.cwiseInverse().asDiagonal() * near->slope, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(rank_ratio);
    const Eigen::Index rank = svd.rank();
    const Eigen::MatrixXd seen = svd.matrixU().leftCols(rank);
    const Eigen::MatrixXd beyond = Eigen::MatrixXd::Identity(sigma.size(), sigma.size()) - seen * seen.transpose();
    const Eigen::MatrixXd inverse =
        svd.matrixV().leftCols(rank) * svd.singularValues().head(rank).cwiseInverse().asDiagonal() * seen.transpose();
    const Eigen::MatrixXd relation = scale.asDiagonal() * beyond * scale.cwiseInverse().asDiagonal();
    const Eigen::VectorXd noise_variance = (relation * sigma.asDiagonal()).rowwise().squaredNorm();
    rows_.push_back({relation, noise_variance, inverse * scale.cwiseInverse().asDiagonal(), std::move(near->bend)});
    largest_rank = std::max(largest_rank, rank);
  }
  count_ = static_cast<int>(sigma.size() - largest_rank);
}

Eigen::VectorXd ParityRelations::at(int row, const Eigen::VectorXd& readings, const Eigen::VectorXd& measured) const {
  const Row& at = rows_[static_cast<std::size_t>(row)];
  const Eigen::VectorXd moved = at.to_pose * (readings - measured);
  Eigen::VectorXd straight = readings;
  for (Eigen::Index i = 0; i < straight.size(); ++i)
    straight[i] -= 0.5 * moved.dot(at.bend[static_cast<std::size_t>(i)].lazyProduct(moved));
  return at.relation * straight;
}

double ParityRelations::shareBeyondPose(int row, Eigen::Index position) const {
  return rows_[static_cast<std::size_t>(row)].relation(position, position);
}

double ParityRelations::noiseVariance(int row, Eigen::Index position) const {
  return rows_[static_cast<std::size_t>(row)].noise_variance[position];
}

}  // namespace musclesim
