/// A hypothesis is one effect on one component; its strength is a point in coordinates that a fit can use.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../model/plant.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// Coordinates z, one per parameter that a fit changes:
///   neutral value finite      value = neutral + z * (typical - neutral)
///   neutral value infinite    value = typical / z
///   shape parameters          value = typical * exp(z), or typical + z * half the usual range if that does not lie above 0
/// z = 0 is neutral for the first two and usual for the third; z = 1 is a typical strength, or the one that rescale() set. Values are
/// clamped to their range.
class Hypothesis {
 public:
  Hypothesis(EffectInfo info, std::string component, const Plant& plant);

  const EffectInfo& info() const { return info_; }
  const std::string& component() const { return component_; }
  std::string label() const { return info_.id + "@" + component_; }
  /// Component and part of the machine: how the pressure follows the command, what the pressure moves, or the sensors. Effects of one place
  /// may act alike. The only joint, muscle or signal is no other component than all of them.
  std::string place() const;
  int coordinateCount() const { return static_cast<int>(coordinates_.size()); }
  /// Numbers that were counted in the recordings or tried one by one instead of fitted.
  int countedParameters() const { return coordinates_.empty() ? static_cast<int>(info_.parameters.size()) : 0; }
  /// On how many components of the plant the effect could act alone: how often "one of them" was tried. 1 for "all".
  int placeCount() const { return place_count_; }
  /// Coordinates that are mechanisms beside the effect's own (EffectParameter::adds_mechanism).
  std::vector<int> furtherMechanisms() const;
  /// Indices of the coordinates that are strengths: at 0 the effect vanishes.
  const std::vector<int>& strengths() const { return strengths_; }
  /// Names of the parameters that are strengths, in order.
  std::vector<std::string> strengthNames() const;
  /// Whether a strength may have either sign.
  bool isSigned(int coordinate) const;
  /// Makes the strength at `z` the new z = 1, with the other sign if `z` is negative.
  void rescale(int coordinate, double z);
  /// Fixes a coordinate at neutral and removes it; the indices of those after it decrease by one.
  void leaveOut(int coordinate);
  /// Whether a coordinate is a time.
  bool isTime(int coordinate) const;
  /// The coordinate of the same parameter for the other direction, venting for filling and the reverse; -1 if there is none.
  int counterpartOf(int coordinate) const;
  /// The coordinate at which a parameter has the value that another one has at z_of_other.
  double coordinateLike(int coordinate, int other, double z_of_other) const;
  ActiveEffect at(const Eigen::VectorXd& z) const;
  /// Names and values of the parameters that z changes, and of those fixed at a value other than neutral.
  std::vector<std::pair<std::string, double>> valuesAt(const Eigen::VectorXd& z) const;
  /// The inverse of valuesAt: parameters that are not given are neutral or, if they are shapes, usual.
  Eigen::VectorXd coordinatesOf(const std::map<std::string, Parameter::Value>& values) const;
  /// The coordinates that come nearest to an effect of this kind, and how many of its numbers are others there.
  std::pair<Eigen::VectorXd, int> nearestTo(const ActiveEffect& effect) const;
  /// Names and words of the parameters that are words and matter on this component.
  std::map<std::string, std::string> choices() const;
  /// How far parameters leave their usual range, 0 within it: for strengths the sum of ln(distance from neutral / largest usual distance),
  /// for shapes of ln(factor beyond the nearer end of the range). Strengths in units of the signal have no usual range.
  double excess(const Eigen::VectorXd& z) const;
  /// z with every coordinate between the bounds that the parameters' ranges give.
  Eigen::VectorXd clamped(Eigen::VectorXd z) const;
  /// All strengths 1, all shape parameters usual.
  Eigen::VectorXd typical() const;
  /// One copy of the hypothesis for each choice that a fit cannot reach from another one: a wall on either side of each axis, a number of
  /// bits, either end of a muscle, stops that are hard or give way, a law with and without a share of something.
  std::vector<Hypothesis> variants(const Plant& plant) const;

 private:
  static constexpr double strongest = 25;  ///< bound of strengths, in multiples of the usual extent
  enum class Scale { linear, inverse, factor, shift };
  struct Coordinate {
    std::size_t parameter;
    Scale scale;
    double typical, unit;
    double farthest = 0;  ///< bound of the distance from neutral (inverse: least value); 0: only the parameter's own range bounds it
  };
  double valueOf(const Coordinate& coordinate, double z) const;
  double stretchOf(int coordinate, double z) const;
  double coordinateOf(const Coordinate& coordinate, double value) const;
  void useCorrectedLaw(const Plant& plant);
  void countHeld(const Plant& plant);
  std::vector<Hypothesis> numbersOfBits() const;
  std::vector<Hypothesis> smallAndLarge() const;
  std::vector<Hypothesis> withAndWithoutShares() const;
  std::vector<Hypothesis> eachLaw(const Plant& plant) const;
  std::vector<Hypothesis> ends(const Plant& plant) const;
  std::vector<Hypothesis> togetherAndAlone() const;
  std::vector<Hypothesis> sides(const Plant& plant) const;
  std::vector<Hypothesis> hardAndYielding() const;

  EffectInfo info_;
  std::string component_;
  std::vector<double> base_;  ///< values of the parameters that z does not change
  std::vector<Coordinate> coordinates_;
  std::vector<int> strengths_;
  int place_count_ = 1;

  friend std::vector<Hypothesis> hypotheses(const Plant& plant, const DiagnosisOptions& options);
};

/// Whether the options' candidates and exclude lists allow an effect as an answer.
bool allows(const DiagnosisOptions& options, const std::string& id);
/// All hypotheses that the options allow on this plant.
std::vector<Hypothesis> hypotheses(const Plant& plant, const DiagnosisOptions& options);

}  // namespace musclesim
