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
int signalNumber(const Plant& plant, const std::string& name);

/// RMS over floor of all cells of signals whose name begins with a word; nothing if there are none.
std::optional<double> ratioOf(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);
/// The largest RMS over floor of a cell, averaged or not, of signals of motion (angles, lengths, positions).
double largestMotionRatio(const Comparison& comparison, const Eigen::VectorXd& residual);
/// The signal whose name begins with a word that stands out of its floor most; empty if there is none.
std::string mostAffected(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning);

bool allPressuresMeasured(const Plant& plant);
/// The residual when the measured pressures are the commands; empty if the model cannot follow.
Eigen::VectorXd residualUnderMeasuredPressures(const Comparison& comparison);

/// Of measured tension minus that of the law at measured pressure and length, over what noise of all three gives; of the muscle in which it
/// is largest.
struct TensionTest {
  double found = 0;        ///< RMS ratio
  double expected = 0;     ///< if all of the gap in the length arose in the law
  bool commanded = false;  ///< pressures are not measured: those that were commanded stand for them
};
/// Nothing if length or tension is missing. Commanded pressures are taken where the model makes them pressures as they are.
std::optional<TensionTest> testTension(const Comparison& comparison, const Eigen::VectorXd& residual);

/// Whether signals of motion agree with each other as in the model, whatever the motion: on a plant with one degree of freedom each is a
/// function of any other.
struct MotionTest {
  bool agree = false;         ///< all that could be compared agree, though a fault of one of them would show
  std::string odd;            ///< the one signal that does not fit the others; empty if there is none
  double odd_ratio = 0;       ///< by how many times the noise
  bool others_right = false;  ///< the others are as predicted
};
/// Nothing if there are no two signals of motion of which one is a function of the other.
std::optional<MotionTest> testMotion(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
