/// An explanation is a set of hypotheses with fitted coordinates, fitted together with the uncertain numbers of the model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "../fit/comparison.h"
#include "../fit/hypothesis.h"
#include "../fit/refit.h"
#include "../fit/sensitivity.h"

namespace musclesim {

struct Explanation {
  std::vector<std::size_t> members;                ///< indices of hypotheses; empty: no effect
  Eigen::VectorXd z;                               ///< coordinates of all members, one after the other
  Eigen::VectorXd numbers;                         ///< coordinates of the uncertain numbers (Plant::numbersAt)
  Eigen::VectorXd half_width, numbers_half_width;  ///< of their 95 % intervals
  Eigen::VectorXd determined;                      ///< Certainty::determined of z; empty before a fit
  Eigen::VectorXd residual;                        ///< on the comparison that it was fitted to last
  Eigen::MatrixXd jacobian;                        ///< of the prediction there, by z and then numbers
  double score = 0;                                ///< Evidence::score
  double probability = 0;
  bool is_inactive = false;  ///< one of its effects is inactive: the fit is as good at nearly zero strength
  /// The same effects, fitted with the further mechanisms that their laws leave out here (a valve's second lag); null if there are none.
  std::shared_ptr<const Explanation> with_mechanisms;
};

/// Takes over the certainty of a fit of z and numbers; an empty one makes it unknown.
void setCertainty(Explanation& explanation, const Certainty& certainty);

/// What a fit is for: a misfit that ranks explanations, or parameters that are reported.
enum class Accuracy { ranking, estimates };
/// Where known derivatives were computed: at the parameters from which a fit begins, or at others.
enum class Known { here, elsewhere };

/// The hypotheses of a plant, and what a set of them means.
class Causes {
 public:
  Causes(const Plant& plant, const OnSimulation& on_simulation) : plant_(plant), on_simulation_(on_simulation) {}

  std::vector<Hypothesis> hypotheses;

  const Plant& plant() const { return plant_; }
  Model modelOf(const Explanation& explanation) const;
  /// Labels of the members, in order of the alphabet.
  std::set<std::string> labelsOf(const std::vector<std::size_t>& members) const;
  /// Whether two hypotheses are the same effect on places that overlap: they cannot act together.
  bool clash(std::size_t one, std::size_t other) const;
  /// Index of the first coordinate of a member.
  Eigen::Index firstCoordinate(const Explanation& explanation, std::size_t member) const;
  /// A member of an explanation with its own coordinates.
  struct Part {
    std::size_t hypothesis;
    Eigen::VectorXd z;
  };
  std::vector<Part> partsOf(const Explanation& explanation) const;
  /// An explanation of these parts, not fitted yet.
  static Explanation assembled(const std::vector<Part>& parts, const Eigen::VectorXd& numbers);
  /// The explanation without one of its members, the others unchanged.
  Explanation without(const Explanation& explanation, std::size_t member) const;
  /// The explanation with one more member, at these values of its parameters (Hypothesis::coordinatesOf); not fitted yet.
  Explanation with(const Explanation& explanation, std::size_t hypothesis, const std::map<std::string, Parameter::Value>& values) const;
  /// The explanation, not fitted yet, with what another one has: the numbers of the model, and the variants and coordinates of the effects
  /// that both have.
  Explanation takingOver(const Explanation& explanation, const Explanation& other) const;
  /// The explanation with other variants of its effects, not fitted yet: laws with further mechanisms, or laws without them. A mechanism
  /// that the explanation did not have begins with a share of zero.
  Explanation withFurtherMechanisms(const Explanation& explanation) const;
  Explanation withoutFurtherMechanisms(const Explanation& explanation) const;
  Eigen::VectorXd clamped(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const;
  /// The fit of all coordinates and numbers to a comparison. References must outlive the problem.
  FitProblem problemOf(const Explanation& explanation, const Comparison& comparison, Fidelity fidelity) const;
  /// Fits on, from where the explanation is; `known` as FitProblem::known_derivatives, `largest_cost` as FitProblem::largest_cost.
  void refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity, Accuracy accuracy,
             std::vector<SharedVector> known = {}, Known known_from = Known::elsewhere,
             double largest_cost = std::numeric_limits<double>::infinity()) const;
  /// Fits on in coarse steps, with one coordinate of the effects held where it is.
  void refitHolding(Explanation& explanation, Eigen::Index coordinate, const Comparison& comparison, int rounds) const;
  /// Takes the last steps of a fit and the intervals there (musclesim::finish).
  void finish(Explanation& explanation, const Comparison& comparison) const;

 private:
  /// The explanation at the values that it has, with other variants of its members.
  Explanation inVariants(const Explanation& explanation,
                         const std::function<bool(const Hypothesis& own, const Hypothesis& other)>& isWanted) const;

  const Plant& plant_;
  const OnSimulation& on_simulation_;
};

/// Whether two components overlap: one of them is "all", or both name a common part.
bool overlap(const std::string& one, const std::string& other);

}  // namespace musclesim
