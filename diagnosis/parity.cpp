#include "parity.h"

#include <Eigen/SVD>

#include "../simulation/measured_pose.h"

namespace musclesim {

namespace {

/// A coordinate that moves the readings by less than this share of what another one does is not seen by them.
constexpr double rank_ratio = 1e-3;

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
    const Eigen::MatrixXd slopes = poses.slopes(row, own_names);
    if (slopes.rows() == 0 || !slopes.allFinite()) {
      relations_.clear();
      return;
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(sigma.cwiseInverse().asDiagonal() * slopes, Eigen::ComputeThinU);
    svd.setThreshold(rank_ratio);
    const auto seen = svd.matrixU().leftCols(svd.rank());
    const Eigen::MatrixXd beyond = Eigen::MatrixXd::Identity(sigma.size(), sigma.size()) - seen * seen.transpose();
    relations_.push_back(sigma.asDiagonal() * beyond * sigma.cwiseInverse().asDiagonal());
    largest_rank = std::max(largest_rank, svd.rank());
  }
  count_ = static_cast<int>(sigma.size() - largest_rank);
}

}  // namespace musclesim
