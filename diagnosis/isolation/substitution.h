/// Substitution tests: evidence on the stage of a gap from measured signals put into parts of the model, without any effect.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "../fit/comparison.h"

namespace musclesim {

inline constexpr double agrees = 1.2;     ///< RMS over sigma below which a signal counts as predicted
inline constexpr double disagrees = 1.5;  ///< RMS over sigma above which it counts as not predicted

/// RMS over sigma of all residual blocks of signals whose name begins with a word; empty if there are none.
std::optional<double> ratioOf(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);
/// Largest RMS over sigma of a residual block, averaged or not, of signals of motion (angles, lengths, positions).
double largestMotionRatio(const Comparison& comparison, const Eigen::VectorXd& residual);
/// Of the signals whose name begins with a word, the one with the largest RMS over sigma; empty if there is none.
std::string mostAffected(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);

/// Whether every muscle's pressure can be compared in every segment.
bool allPressuresMeasured(const Comparison& comparison);

/// How well the model predicts motion and tension if it gets the measured pressures as commands.
struct PressureTest {
  double share = 0;  ///< share of their gap that the pressures explain: 1 if all of it arose in or before the pressures, 0 if none did
  double share_deviation = 0;  ///< standard deviation of share due to the noise of the pressures
  double misfit = 0;           ///< mean ln(RMS / sigma) of their gap
  double misfit_increase = 0;  ///< increase of misfit under the measured pressures; the noise that these cause counts as part of sigma
};
/// Measured pressures are noisy, and the model moves with their noise: often by more than the motion's own noise, sometimes by more than
/// its gap. Let r be measured minus predicted, s the change that the measured pressures cause, n the change that a further draw of white
/// noise of the pressures' sigmas causes, and w = 1 / (sigma^2 + mean n^2) in each residual block. Then
///   share = sum w r s / sum w (r^2 - sigma^2)    over the blocks in which r stands out of the noise.
/// Noise in s makes the share uncertain (by the spread of r n in place of r s) but does not bias it, because r does not depend on that
/// noise: this is the regression of the variable with errors on the one without (Fuller, Measurement Error Models, 1987). If pressures
/// touch 0 or 1, a further draw is clipped like the noise that they already contain, and n is an approximation. Pressures are taken to
/// change linearly between rows: each command is the mean of a row's pressure and the next row's. Returns nothing if the model diverges or
/// pressures are missing.
std::optional<PressureTest> testPressures(const Comparison& comparison, const Eigen::VectorXd& residual);

/// Measured tension minus the law's tension at measured pressure and length, over the noise that all three cause; for the muscle with the
/// largest ratio.
struct TensionTest {
  double found = 0;                                    ///< RMS ratio
  double expected = 0;                                 ///< RMS ratio if all of the gap in the length arose in the law
  bool some_commanded = false, all_commanded = false;  ///< some or all pressures are not measured; commanded ones are used instead
  bool of_all_muscles = false;                         ///< length and tension of all muscles are measured
};
/// Returns nothing if length or tension is missing, or if the model already holds effects on tensions or sensors, because it then predicts
/// more than the law alone. Commanded pressures are used only if the model turns commands into pressures unchanged.
std::optional<TensionTest> testTension(const Comparison& comparison, const Eigen::VectorXd& residual);

/// Whether signals of motion are consistent with each other as in the model, for any motion: with one degree of freedom each is a function
/// of any other.
struct MotionTest {
  bool agree = false;                 ///< all compared signals are consistent, and a fault of one of them would show
  std::vector<std::string> compared;  ///< signals that are a function of at least one other
  bool compared_all = false;          ///< these are all signals of motion
  std::string odd;                    ///< the only signal that contradicts the others; empty if there is none
  double odd_ratio = 0;               ///< contradiction in multiples of the noise
  bool others_right = false;          ///< the other signals are as predicted
};
/// Returns nothing unless at least one signal of motion is a function of another.
std::optional<MotionTest> testMotion(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
