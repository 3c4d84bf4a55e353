/// Measured minus predicted, over chosen stretches, in one long vector.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "plant.h"

namespace musclesim {

inline constexpr std::size_t averaging_rows = 16;  ///< that many rows are averaged
inline constexpr double steady_share = 0.2;        ///< of a noise floor that does not average out: what the model's own steps leave

/// What part of a signal's noise floor is left in averages over blocks: sqrt(1 / n + steady_share^2), n readings per block, where a
/// reading that is held in the next rows is one. Values that are no numbers are left out.
double averagedShareOfSigma(const std::vector<double>& values);

/// The mean of the `index`-th block of averaging_rows rows, the first of which begins at `first`.
inline double meanOfBlock(const Eigen::VectorXd& values, Eigen::Index first, Eigen::Index index) {
  constexpr auto rows = static_cast<Eigen::Index>(averaging_rows);
  return values.segment(first + index * rows, rows).mean();
}

/// The compared rows of some stretches. A cell is one signal in one stretch, or the same averaged over blocks of rows: there noise is
/// smaller, and what is weak but slow stands out.
class Comparison {
 public:
  struct Block {
    std::size_t segment;
    int signal;
    std::vector<int> rows;  ///< those with a measured number, or the first ones of the blocks
    Eigen::Index first;     ///< where its rows begin in the vectors
    double sigma;
    std::size_t averaged_rows = 0;    ///< rows of a block; 0: not averaged
    Eigen::Index first_averaged = 0;  ///< where the rows that are averaged begin
    Eigen::Index count() const { return static_cast<Eigen::Index>(rows.size()); }
  };
  enum class Averages { without, with };

  Comparison(const Plant& plant, std::vector<Segment> segments, Averages averages = Averages::without);

  const Plant& plant() const { return plant_; }
  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  /// The cell of this comparison's only stretch with the signal and averages of a cell of another comparison.
  const Block& blockLike(const Block& other) const;
  Eigen::Index size() const { return size_; }

  enum class Purpose { fitting, screening };  ///< a look only chooses what is fitted further

  /// From here on predictions are coarse, corrected by what coarse steps change in the model without effects: medium where coarse steps
  /// change a signal by more than a few floors, since they follow another motion then, and fine where medium ones do. A look begins
  /// with the coarsest steps and bears a tenth of a signal's gap where that is more than those floors. A model that diverges in coarse
  /// steps is simulated in fine ones. `nominal` is the fine prediction of the model without effects.
  void goCoarse(const Eigen::VectorXd& nominal, Purpose purpose = Purpose::fitting);
  Fidelity fidelity() const { return fidelity_; }
  /// Where even medium steps follow another motion, what they change; empty otherwise, and before goCoarse.
  const Unsteady& unsteady() const { return unsteady_; }

  /// What a model predicts at the compared rows; empty if it diverges on one of the stretches.
  Eigen::VectorXd predicted(const Model& model) const;
  Eigen::VectorXd predicted(const Model& model, Fidelity fidelity) const;
  /// The same from simulations made elsewhere, in fine steps or with fidelity().
  Eigen::VectorXd predicted(const std::vector<Prediction>& per_segment, Fidelity fidelity) const;
  const Eigen::VectorXd& measured() const { return measured_; }

  /// The same where logMisfit and weights are those of plain least squares, every cell in units of its floor and its part of a residual
  /// together (root of the sum of squares). Far from the best fit that has fewer minima: the logarithm rewards one cell that fits very
  /// well.
  Comparison bySquares(const Eigen::VectorXd& residual) const;

  /// Mean square of a vector's part in one cell.
  double meanSquare(const Block& block, const Eigen::VectorXd& residual) const;
  /// ln of the RMS residual over the floor, 0 below the floor, summed over all cells; infinite for an empty vector.
  double logMisfit(const Eigen::VectorXd& residual) const;
  /// 1 / (RMS sqrt(rows)) for each row, RMS its cell's residual but not less than the floor: makes least squares follow logMisfit.
  Eigen::VectorXd weights(const Eigen::VectorXd& residual) const;
  /// normalised gap and its parts.
  Gap gap(const Eigen::VectorXd& residual) const;
  /// Number of cells in which the residual stands out of the floor (RMS > 1.15 floor), at least 1.
  int affectedBlocks(const Eigen::VectorXd& residual) const;

 private:
  void addAverages();
  void average(Eigen::VectorXd& values) const;
  Unsteady unsteadiness(const Eigen::VectorXd& change, const Eigen::VectorXd& residual) const;
  Eigen::VectorXd gathered(const std::vector<Prediction>& per_segment) const;

  const Plant& plant_;
  bool by_squares_ = false;
  Fidelity fidelity_ = Fidelity::fine;
  Unsteady unsteady_;
  Eigen::VectorXd correction_;  ///< fine minus coarse
  std::vector<Segment> segments_;
  std::vector<Block> blocks_;
  Eigen::Index size_ = 0;
  Eigen::VectorXd measured_;
};

/// No signal stands out of its floor: RMS below 1.15 floors, or 1.3 where the floor itself had to be estimated; nor in a single stretch of
/// 200 rows or more by 1.3 or 1.5.
bool isWithinNoise(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
