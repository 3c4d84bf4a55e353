/// A suspect is one effect on one component; its strength is a point in coordinates that a fit can use.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"
#include "plant.h"

namespace musclesim {

/// Coordinates z of one suspect's parameters, one per parameter that a fit changes:
///   neutral value finite      value = neutral + z * (typical - neutral)
///   neutral value infinite    value = typical / z
///   shape parameters          value = typical * exp(z), or typical + z * half the usual range where that has both signs
/// z = 0 is neutral for the first two and usual for the third; z = 1 is a typical strength, or what the first look took in its place (see
/// rescale). Values are clamped to their range.
class Hypothesis {
 public:
  Hypothesis(EffectInfo info, std::string component, const Plant& plant);

  const EffectInfo& info() const { return info_; }
  const std::string& component() const { return component_; }
  std::string label() const { return info_.id + "@" + component_; }
  int coordinateCount() const { return static_cast<int>(coordinates_.size()); }
  /// Numbers of the coordinates that are strengths: those with which the effect vanishes.
  const std::vector<int>& strengths() const { return strengths_; }
  /// Whether a strength may have either sign.
  bool isSigned(int coordinate) const;
  /// From here on z = 1 is the strength that `z` stood for; of the other sign where that is negative.
  void rescale(int coordinate, double z);
  /// From here on a coordinate stays neutral and is none; those after it count one less.
  void leaveOut(int coordinate);
  /// Whether it is a time.
  bool isTime(int coordinate) const;
  /// The coordinate of the other direction, venting for filling and the reverse; -1: there is none.
  int counterpartOf(int coordinate) const;
  /// Where a coordinate stands for the value that another one has.
  double coordinateLike(int coordinate, int other, double z_of_other) const;
  ActiveEffect at(const Eigen::VectorXd& z) const;
  /// Names and values of the parameters that z changes, and of those that are set to something else than neutral.
  std::vector<std::pair<std::string, double>> valuesAt(const Eigen::VectorXd& z) const;
  /// Names and words of the parameters that are words and matter on this component.
  std::map<std::string, std::string> choices() const;
  /// How far strengths lie beyond their usual range: sum of ln(distance from neutral / largest usual one), 0 within the range. Strengths in
  /// units of the signal have no usual range.
  double excess(const Eigen::VectorXd& z) const;
  /// z with every coordinate between the bounds that the parameters' ranges give.
  Eigen::VectorXd clamped(Eigen::VectorXd z) const;
  /// All strengths 1, all shapes usual.
  Eigen::VectorXd typical() const;
  /// The suspect once for each choice that no fit can reach from another one: a wall on either side of each axis, a
  /// number of bits, either end of a muscle, a law with a share of something and without.
  std::vector<Hypothesis> variants(const Plant& plant) const;

 private:
  static constexpr double strongest = 25;  ///< times the usual extent: bound of strengths
  enum class Scale { linear, inverse, factor, shift };
  struct Coordinate {
    std::size_t parameter;
    Scale scale;
    double typical, unit;
    double farthest = 0;  ///< from neutral (inverse: the least value); 0: only the parameter's own range bounds it
  };
  double valueOf(const Coordinate& coordinate, double z) const;
  double coordinateOf(const Coordinate& coordinate, double value) const;
  void useCorrectedLaw(const Plant& plant);
  void countHeld(const Plant& plant);
  std::vector<Hypothesis> numbersOfBits() const;
  std::vector<Hypothesis> smallAndLarge() const;
  std::vector<Hypothesis> withAndWithoutShares() const;
  std::vector<Hypothesis> ends(const Plant& plant) const;
  std::vector<Hypothesis> togetherAndAlone() const;

  EffectInfo info_;
  std::string component_;
  std::vector<double> base_;  ///< values of all parameters where z does not change them
  std::vector<Coordinate> coordinates_;
  std::vector<int> strengths_;
};

/// Whether the options' candidates and exclude let an effect be an answer.
bool allows(const DiagnosisOptions& options, const std::string& id);
/// All suspects that the options allow on this plant.
std::vector<Hypothesis> hypotheses(const Plant& plant, const DiagnosisOptions& options);

}  // namespace musclesim
