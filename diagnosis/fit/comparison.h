/// Residuals (measured minus predicted) of chosen segments, in one long vector.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "../model/plant.h"

namespace musclesim {

/// A vector over all compared rows that several keep without copies of it.
using SharedVector = std::shared_ptr<const Eigen::VectorXd>;
/// Null for an empty vector.
inline SharedVector shared(Eigen::VectorXd values) {
  return values.size() ? std::make_shared<const Eigen::VectorXd>(std::move(values)) : nullptr;
}

inline constexpr std::size_t averaging_rows = 16;  ///< rows per averaging block
inline constexpr double steady_share = 0.2;        ///< share of sigma that averaging does not reduce: errors of the model's own time steps

/// Noise sigma of block averages over the noise sigma of rows: sqrt(1 / n + steady_share^2), n readings per block. A reading that is held
/// in the following rows counts once; values that are not finite are left out.
double averagedShareOfSigma(const std::vector<double>& values);

/// Mean of the `index`-th averaging block of rows that begin at `first`.
inline double meanOfBlock(const Eigen::VectorXd& values, Eigen::Index first, Eigen::Index index) {
  constexpr auto rows = static_cast<Eigen::Index>(averaging_rows);
  return values.segment(first + index * rows, rows).mean();
}

/// A share rho of the gap that the right cause may leave because its law differs from ours, and the nats per e-fold of residual beyond it.
struct Tolerance {
  double share_of_gap, nats;
};
/// Found by conditional logit on plants with known causes; docs/developer/diagnosis_choices.md says on which.
inline constexpr std::array<Tolerance, 3> tolerances = {{{0.1, 1.625}, {0.03, 1.125}, {0.01, 1.125}}};

/// The compared rows of some segments. A residual block is one signal in one segment, either row by row or averaged over blocks of rows:
/// averages have less noise, so weak but slow differences stand out. Blocks of parity hold by what signals of motion contradict each other:
/// there a fault of one sensor stands out, however well the motion itself is explained.
class Comparison {
 public:
  struct Block {
    std::size_t segment;
    int signal;
    std::vector<int> rows;  ///< rows with a measured value, or the first row of each averaging block
    Eigen::Index first;     ///< index of its first row in the vectors
    double sigma;
    std::size_t averaged_rows = 0;    ///< rows per average; 0: not averaged
    bool is_parity = false;           ///< not the signal itself, but what of it no pose of the robot explains (ParityRelations)
    double power = 1;                 ///< of its evidence: a channel's share, see shareEvidence; its readings where nothing is tempered
    double gap = 0;                   ///< RMS of the gap
    Eigen::Index first_averaged = 0;  ///< index of the first row that is averaged
    Eigen::Index count() const { return static_cast<Eigen::Index>(rows.size()); }
    /// Whether its values are readings: neither averages nor parity, which are computed from readings.
    bool isReading() const { return averaged_rows == 0 && !is_parity; }
  };
  enum class Derived { without, with };  ///< blocks that are computed from readings: averages, and parity of the signals of motion

  Comparison(const Plant& plant, std::vector<Segment> segments, Derived derived = Derived::without);

  const Plant& plant() const { return plant_; }
  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  Eigen::Index size() const { return size_; }

  enum class Purpose { fitting, screening };  ///< screening only chooses what is fitted further

  /// From here on predictions use coarse time steps, corrected by the change that coarse steps cause in the model without effects. Medium
  /// steps are used if coarse ones change a signal by more than a few noise sigmas, because the motion is then another one. Screening
  /// begins with the coarsest steps and tolerates a tenth of a signal's gap where that is more than those sigmas. Where even medium steps
  /// change the motion, the change that they make is added to the noise of every block (as squares): the model is not known any better, so
  /// that medium steps serve there too. A robot of few internal steps is always simulated in fine ones. There the change that muscles a
  /// thousandth stronger make is added to the noise, if it is more than a few sigmas of a signal and a tenth of its motion. Call once.
  /// A model that diverges in coarse steps is simulated in fine ones. `nominal` is the fine prediction of the model without effects.
  void goCoarse(const Eigen::VectorXd& nominal, Purpose purpose = Purpose::fitting);
  Fidelity fidelity() const { return fidelity_; }
  /// The change that counts as noise, of medium steps or stronger muscles; empty if none does, and before goCoarse.
  const Unsteady& unsteady() const { return unsteady_; }

  /// Prediction of a model at the compared rows; empty if it diverges on one of the segments.
  Eigen::VectorXd predicted(const Model& model) const;
  Eigen::VectorXd predicted(const Model& model, Fidelity fidelity) const;
  /// Measured minus predicted; empty if the model diverges.
  Eigen::VectorXd residualOf(const Model& model) const;
  /// The prediction of a model in which the sensor of one signal only is faulty: of `faulty` for that signal, of `base` for all others.
  /// What is computed from readings is that of both together. So one simulation tells what a fault does to each sensor alone.
  Eigen::VectorXd predictedInOne(int signal, const Model& faulty, const Model& base) const;
  /// The prediction from simulations made elsewhere, in fine steps or with fidelity().
  Eigen::VectorXd predicted(const std::vector<Prediction>& per_segment, Fidelity fidelity) const;
  const Eigen::VectorXd& measured() const { return measured_; }

  /// Which signals count in misfits and weights from here on; the others get no power, and predictions have the values of the model
  /// without effects for them.
  void focusOn(Focus focus);

  /// Mean square of the part of a vector that belongs to one block.
  double meanSquare(const Block& block, const Eigen::VectorXd& residual) const;
  /// Tells how large the gap is: what the right cause may leave if its law differs from ours grows with it (misfit). `nominal_residual`
  /// is that of the model without effects.
  void setGap(const Eigen::VectorXd& nominal_residual);
  /// The tempered misfit of a residual, in nats, 0 for noise alone:
  ///   sum over blocks b of power_b  sum over tolerances (rho, kappa) of  kappa / 2 ln((s^2 + ms_b) / (s^2 + sigma_b^2)),
  ///   s^2 = sigma_b^2 + rho^2 C_b^2
  /// or, where tempering is left out (MethodPart), the sum over readings of (residual^2 / sigma^2 - 1) / 2.
  /// ms_b: mean square of the residual in the block; C_b: RMS of the gap there (setGap); power_b: see Block. Infinite for an empty vector.
  double misfit(const Eigen::VectorXd& residual) const;
  /// The misfit by tolerance, each without its kappa.
  std::array<double, tolerances.size()> misfits(const Eigen::VectorXd& residual) const;
  /// The part of a block.
  double misfitOf(const Block& block, double mean_square) const;
  /// For each row the root of d(2 misfit) / d(r^2): least squares with these weights follows the misfit.
  Eigen::VectorXd weights(const Eigen::VectorXd& residual) const;
  /// The same weight squared, times the rows of the block.
  double weightSquare(const Block& block, double mean_square) const;
  /// The misfit of a residual e times as large as the noise in all blocks, if nothing were tolerated: a scale for misfits.
  double scale() const;
  /// The normalised gap and its parts per signal.
  Gap gap(const Eigen::VectorXd& residual) const;

 private:
  void addParity();
  using SeriesOf = std::function<const std::vector<double>&(std::size_t segment, int signal)>;
  void fillParity(Eigen::VectorXd& values, const SeriesOf& seriesOf) const;
  void addAverages();
  void shareEvidence();
  bool counts(const Block& block) const;
  bool isTempered() const { return !plant_.leavesOut(MethodPart::tempering); }
  void average(Eigen::VectorXd& values) const;
  bool isSensitive(const Eigen::VectorXd& change) const;
  void countAsNoise(const Eigen::VectorXd& change, const Eigen::VectorXd& residual, Unsteady::Change by);
  Unsteady unsteadiness(const Eigen::VectorXd& change, const Eigen::VectorXd& residual) const;
  Eigen::VectorXd withNominal(Eigen::VectorXd prediction) const;
  Eigen::VectorXd gathered(const std::vector<Prediction>& per_segment) const;
  Eigen::VectorXd corrected(const std::function<Eigen::VectorXd(Fidelity)>& predictedIn) const;

  const Plant& plant_;
  Fidelity fidelity_ = Fidelity::fine;
  Unsteady unsteady_;
  Focus focus_ = Focus::all_signals;
  Eigen::VectorXd nominal_;     ///< prediction of the model without effects, in fine steps; empty before goCoarse
  Eigen::VectorXd correction_;  ///< fine minus coarse prediction of the model without effects
  std::vector<Segment> segments_;
  std::vector<Block> blocks_;
  Eigen::Index size_ = 0;
  Eigen::VectorXd measured_;
};

/// Whether no signal stands out of its noise: RMS below out_of_noise sigmas, or out_of_estimated_noise where sigma is estimated; and in
/// each single segment of 200 rows, or averages of rows, or more below 1.3 or 1.5 sigmas.
bool isWithinNoise(const Comparison& comparison, const Eigen::VectorXd& residual);

/// The signal that stands out of its noise by most beside its motion; 0 percent if none does.
SmallGap largestBesideMotion(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
