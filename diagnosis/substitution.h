/// What measured signals say of each other through parts of the model: evidence on where a gap arises that needs no effect.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "comparison.h"

namespace musclesim {

inline constexpr double agrees = 1.2;     ///< RMS over floor up to which something counts as predicted
inline constexpr double disagrees = 1.5;  ///< from which on it counts as not

/// Number of a compared signal; -1 if it is not compared.
int signalIndex(const Plant& plant, const std::string& name);

/// RMS over floor of all cells of signals whose name begins with a word; nothing if there are none.
std::optional<double> ratioOf(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);
/// The largest RMS over floor of a cell, averaged or not, of signals of motion (angles, lengths, positions).
double largestMotionRatio(const Comparison& comparison, const Eigen::VectorXd& residual);
/// The signal whose name begins with a word that stands out of its floor most; empty if there is none.
std::string mostAffected(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);

/// Whether every muscle's pressure is there to compare in every stretch.
bool allPressuresMeasured(const Comparison& comparison);

/// What the model does with the measured pressures as its commands; of motion and tension.
struct PressureTest {
  double share = 0;            ///< of their gap that goes with the pressures: 1 if all of it arose before or in these, 0 if none did
  double share_deviation = 0;  ///< its standard deviation by the noise of the pressures
  double misfit = 0;           ///< mean ln(RMS / floor) of their gap
  double misfit_increase = 0;  ///< by which it grows under the measured pressures; noise of these counts as part of the floors
};
/// Measured pressures are noisy, and the model moves with their noise: often more than the motion's own floor, and sometimes more than its
/// gap. Of r, measured minus predicted, s, what the measured pressures change, and n, what a further draw of white noise of the pressures'
/// floors changes beside that, with w = 1 / (floor^2 + mean n^2) in each cell,
///   share = sum w r s / sum w (r^2 - floor^2)    over the cells in which r stands out of the floor
/// which noise in s makes uncertain (as much as r n in place of r s varies) but not larger or smaller, since r knows nothing of it: the
/// regression of the variable with errors on that without (Fuller, Measurement Error Models, 1987). Where pressures touch 0 or 1, a
/// further draw is cut off as the noise that is in them already was, and n is an approximation. Between rows pressures are taken to move
/// evenly: each command is the mean of a row's pressure and the next one's. Nothing if the model cannot follow or pressures are missing.
std::optional<PressureTest> testPressures(const Comparison& comparison, const Eigen::VectorXd& residual);

/// Of measured tension minus that of the law at measured pressure and length, over what noise of all three gives; of the muscle in which it
/// is largest.
struct TensionTest {
  double found = 0;                                    ///< RMS ratio
  double expected = 0;                                 ///< if all of the gap in the length arose in the law
  bool some_commanded = false, all_commanded = false;  ///< pressures are not measured: those that were commanded stand for them
  bool of_all_muscles = false;                         ///< and not only of those whose length and tension are measured
};
/// Nothing if length or tension is missing, or if the model holds effects on tensions or sensors beforehand: the law alone is not what it
/// predicts then. Commanded pressures are taken where the model makes them pressures as they are.
std::optional<TensionTest> testTension(const Comparison& comparison, const Eigen::VectorXd& residual);

/// Whether signals of motion agree with each other as in the model, whatever the motion: on a plant with one degree of freedom each is a
/// function of any other.
struct MotionTest {
  bool agree = false;                 ///< all that could be compared agree, though a fault of one of them would show
  std::vector<std::string> compared;  ///< signals of which one other at least is a function
  bool compared_all = false;          ///< those are all signals of motion
  std::string odd;                    ///< the one signal that does not fit the others; empty if there is none
  double odd_ratio = 0;               ///< by how many times the noise
  bool others_right = false;          ///< the others are as predicted
};
/// Nothing if there are no two signals of motion of which one is a function of the other.
std::optional<MotionTest> testMotion(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
