#include "sensitivity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "../../base/parallel.h"
#include "linear_model.h"

namespace musclesim {

namespace {

constexpr double strong = 4;      ///< typical strengths at which a strength without response is tried again
constexpr double nothing = 0.1;   ///< noise sigmas
constexpr double late = 3;        ///< typical strengths at which those are tried again whose response is not proportional
constexpr double useless = 0.99;  ///< share of the misfit left, beyond which a sole strength is tried again at `late`

/// A simulation whose result gives columns of one or more hypotheses.
struct Probe {
  Model model;
  struct Target {
    std::size_t hypothesis, strength;
    int signal;         ///< the only one whose sensor is faulty, see Comparison::predictedInOne; -1: all effects of the model act
    double amount = 1;  ///< of the strength: the change is divided by it
  };
  std::vector<Target> targets;
};

int signalOf(const Comparison& comparison, const Hypothesis& hypothesis) {
  const auto& signals = comparison.plant().signals();
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (comparison.plant().isComponentOf(hypothesis.component(), signals[i].name)) return static_cast<int>(i);
  return -1;
}

std::vector<Probe> probes(const Comparison& comparison, const std::vector<Hypothesis>& hypotheses) {
  std::vector<Probe> result;
  std::map<std::tuple<std::string, std::size_t, int>, std::size_t> shared;  // sensor effects by id, strength and variant
  std::map<std::pair<std::string, std::size_t>, int> variants;              // of a label and strength, until now
  for (std::size_t s = 0; s < hypotheses.size(); ++s)
    for (std::size_t k = 0; k < hypotheses[s].strengths().size() || (k == 0 && hypotheses[s].strengths().empty()); ++k) {
      const Hypothesis& hypothesis = hypotheses[s];
      Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis.coordinateCount());
      if (!hypothesis.strengths().empty()) z[hypothesis.strengths()[k]] = 1;
      const ActiveEffect effect = hypothesis.at(z);
      const bool sensor = hypothesis.info().stage == Stage::sensor && hypothesis.component() != "all";
      const int signal = sensor ? signalOf(comparison, hypothesis) : -1;
      std::size_t index = result.size();
      if (sensor) index = shared.try_emplace({hypothesis.info().id, k, variants[{hypothesis.label(), k}]++}, index).first->second;
      if (index == result.size()) result.push_back({});
      Probe& probe = result[index];
      probe.model.effects.push_back(effect);
      probe.targets.push_back({s, k, signal});
    }
  return result;
}

}  // namespace

double excitationRatio(const Comparison& comparison, const Eigen::VectorXd& change) {
  double largest = 0;
  for (const Comparison::Block& block : comparison.blocks())
    if (block.isReading()) largest = std::max(largest, std::sqrt(comparison.meanSquare(block, change)) / block.sigma);
  return largest;
}

void fitLinearly(const Comparison& comparison, const Hypothesis& hypothesis, const Eigen::VectorXd& residual, Sensitivity& sensitivity) {
  const auto count = static_cast<Eigen::Index>(sensitivity.per_strength.size());
  sensitivity.amount = Eigen::VectorXd::Zero(count);
  sensitivity.misfit = comparison.misfit(residual);
  Eigen::MatrixXd columns(residual.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SharedVector& change = sensitivity.per_strength[static_cast<std::size_t>(i)];
    if (!change) return;
    columns.col(i) = *change;
  }
  Eigen::VectorXd least = Eigen::VectorXd::Zero(count);
  const Eigen::VectorXd most = Eigen::VectorXd::Constant(count, largest_amount);
  for (std::size_t k = 0; k < hypothesis.strengths().size(); ++k)
    if (hypothesis.isSigned(hypothesis.strengths()[k])) least[static_cast<Eigen::Index>(k)] = -largest_amount;
  Eigen::VectorXd left = residual;
  for (int round = 0; round < 3; ++round) {
    const Eigen::VectorXd weights = comparison.weights(left);
    const Eigen::MatrixXd weighted = weights.asDiagonal() * columns;
    Eigen::MatrixXd normal = weighted.transpose() * weighted;
    normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().maxCoeff();
    // An effect without parameters is either present or absent.
    Eigen::VectorXd amount = Eigen::VectorXd::Ones(count);
    if (!hypothesis.strengths().empty()) {  // between bounds, so that strengths that act alike do not drive each other against them
      amount.setZero();
      descend(normal, weighted.transpose() * weights.cwiseProduct(residual), least, most, 0, amount);
    }
    left = residual - columns * amount;
    const double misfit = comparison.misfit(left);
    if (misfit < sensitivity.misfit || hypothesis.strengths().empty()) {
      sensitivity.misfit = misfit;
      sensitivity.amount = amount;
    }
  }
}

namespace {

/// Whether a strength at its typical value changes the prediction visibly.
bool shows(const Comparison& comparison, const Hypothesis& hypothesis, std::size_t strength, const Sensitivity& sensitivity) {
  const double least = hypothesis.isSigned(hypothesis.strengths()[strength]) ? nothing : 1;
  const SharedVector& change = sensitivity.per_strength[strength];
  return (change ? excitationRatio(comparison, *change) : 0) >= least;
}

/// A probe of one strength at an amount, or at the end of its range if that is nearer; none if not even the typical amount is possible.
void addProbe(std::vector<Probe>& probes, const Hypothesis& hypothesis, std::size_t index, std::size_t strength, double amount) {
  const int coordinate = hypothesis.strengths()[strength];
  Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis.coordinateCount());
  z[coordinate] = amount;
  const double possible = hypothesis.clamped(z)[coordinate];
  if (std::abs(possible) < 1) return;
  z[coordinate] = possible;
  probes.push_back({{{hypothesis.at(z)}, {}}, {{index, strength, -1, possible}}});
}

/// Probes of strengths that change nothing at their typical value but would if they were stronger, such as limits that nothing reaches.
/// `direction` -1: only strengths that may have either sign.
std::vector<Probe> strongerProbes(const Comparison& comparison, const std::vector<Hypothesis>& hypotheses,
                                  const std::vector<Sensitivity>& sensitivities, int direction) {
  std::vector<Probe> result;
  for (std::size_t s = 0; s < hypotheses.size(); ++s) {
    if (hypotheses[s].info().stage == Stage::sensor) continue;
    for (std::size_t k = 0; k < hypotheses[s].strengths().size(); ++k) {
      const int coordinate = hypotheses[s].strengths()[k];
      if (!sensitivities[s].per_strength[k]) continue;  // the model diverges with it: weakerProbes
      if ((direction < 0 && !hypotheses[s].isSigned(coordinate)) || shows(comparison, hypotheses[s], k, sensitivities[s])) continue;
      addProbe(result, hypotheses[s], s, k, direction * strong);
    }
  }
  return result;
}

/// Largest ratio of the RMS change in any block, except those of parity, to the RMS residual there, or to sigma if that is larger. It is 1
/// for the right cause at its right strength. Parity hardly takes part in the motion: an effect that shows there stands above a residual of
/// mere noise at any strength.
double sizeOver(const Comparison& comparison, const Eigen::VectorXd& residual, const Eigen::VectorXd& change) {
  double largest = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.is_parity) continue;
    largest = std::max(largest, std::sqrt(comparison.meanSquare(block, change)) /
                                    std::max(block.sigma, std::sqrt(comparison.meanSquare(block, residual))));
  }
  return largest;
}

/// Weakens strengths whose change is much larger than the residual, or with which the model diverges. Returns their probes.
std::vector<Probe> weakerProbes(const Comparison& comparison, std::vector<Hypothesis>& hypotheses, std::vector<Sensitivity>& sensitivities,
                                const Eigen::VectorXd& residual) {
  constexpr double too_much = 3, after_divergence = 0.1;
  std::vector<Probe> result;
  for (std::size_t s = 0; s < hypotheses.size(); ++s) {
    if (hypotheses[s].info().stage == Stage::sensor || sensitivities[s].from_threshold) continue;
    for (std::size_t k = 0; k < hypotheses[s].strengths().size(); ++k) {
      const SharedVector& change = sensitivities[s].per_strength[k];
      const double size = change ? sizeOver(comparison, residual, *change) : 1 / after_divergence;
      if (size < too_much) continue;
      const int coordinate = hypotheses[s].strengths()[k];
      hypotheses[s].rescale(coordinate, 1 / size);
      sensitivities[s].per_strength[k] = nullptr;  // it was the change of the strength before
      Eigen::VectorXd z = Eigen::VectorXd::Zero(hypotheses[s].coordinateCount());
      z[coordinate] = 1;
      result.push_back({{{hypotheses[s].at(z)}, {}}, {{s, k, -1}}});
    }
  }
  return result;
}

/// Adapts the only strength of a hypothesis.
class OnlyStrength {
 public:
  OnlyStrength(const Comparison& comparison, const Eigen::VectorXd& nominal, const Model& base, const OnSimulation& on_simulation,
               Hypothesis& hypothesis, Sensitivity& sensitivity)
      : comparison_(comparison),
        nominal_(nominal),
        base_(base),
        on_simulation_(on_simulation),
        hypothesis_(hypothesis),
        sensitivity_(sensitivity) {}

  /// For a typical strength that shows nothing: increases it, in both directions if it is signed, until it shows, bisects the threshold,
  /// tries ever larger strengths, because a little more may be worse and much more right, and refines around the strength with the least
  /// misfit. Makes that strength the typical one. Derivatives at the threshold say little.
  void searchThreshold() {
    constexpr double growth = 4, grid = 1.25;
    constexpr double farthest = 32;  // typical strengths
    constexpr int halvings = 3;
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !hypothesis_.isSigned(coordinate())) continue;
      double hidden = side, visible = side * growth;
      for (; showing(visible) == Showing::none && !isBound(visible); visible *= growth) hidden = visible;
      if (showing(visible) == Showing::none) continue;
      keepIfNearer(visible);
      for (int i = 0; i < halvings; ++i) {
        const double between = side * std::sqrt(hidden * visible);
        (showing(between) == Showing::none ? hidden : visible) = between;
        keepIfNearer(between);
      }
      for (double larger = grid * visible; std::abs(larger) <= farthest && !isBound(larger); larger *= grid) keepIfNearer(larger);
    }
    if (best_.strength != 0 && best_.misfit < worth_refining * comparison_.misfit(residual())) refine();
    if (best_.strength == 0) return;
    sensitivity_.per_strength = {shared(changeAt(best_.strength))};
    sensitivity_.from_threshold = true;
    hypothesis_.rescale(coordinate(), best_.strength);
  }

  /// Linearises again at the limit of the linear range while that reduces the misfit.
  void relinearise() {
    while (std::abs(sensitivity_.amount[0]) >= largest_amount && !isBound(sensitivity_.amount[0])) {
      Sensitivity farther = sensitivity_;
      farther.per_strength = {shared(changeAt(sensitivity_.amount[0]))};
      if (!farther.per_strength.front()) return;
      fitLinearly(comparison_, hypothesis_, residual(), farther);
      if (!(farther.misfit < sensitivity_.misfit)) return;
      hypothesis_.rescale(coordinate(), sensitivity_.amount[0]);
      sensitivity_ = std::move(farther);
    }
  }

 private:
  struct Found {
    double strength = 0, misfit = 0;
  };
  enum class Showing { none, some, diverged };
  static constexpr double worth_refining = 0.97;  ///< of the misfit without the effect
  int coordinate() const { return hypothesis_.strengths().front(); }
  Eigen::VectorXd residual() const { return comparison_.measured() - nominal_; }
  Eigen::VectorXd at(double strength) const {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis_.coordinateCount());
    z[coordinate()] = strength;
    return z;
  }
  double possible(double strength) const { return hypothesis_.clamped(at(strength))[coordinate()]; }
  bool isBound(double strength) const { return possible(strength) != strength; }
  /// Empty if the model diverges, and once interrupted.
  Eigen::VectorXd changeAt(double strength) const {
    if (comparison_.plant().interrupted()) return {};
    Model model = base_;
    model.effects.push_back(hypothesis_.at(at(possible(strength))));
    const Eigen::VectorXd predicted = comparison_.predicted(model);
    on_simulation_();
    if (predicted.size() != nominal_.size() || !predicted.allFinite()) return {};
    return predicted - nominal_;
  }
  /// `some`: at least one sigma in a block.
  Showing showing(double strength) const {
    const Eigen::VectorXd change = changeAt(strength);
    if (!change.size()) return Showing::diverged;
    return excitationRatio(comparison_, change) >= 1 ? Showing::some : Showing::none;
  }
  void keepIfNearer(double strength) {
    if (showing(strength) != Showing::some) return;
    const double misfit = comparison_.misfit(residual() - changeAt(strength));
    if (best_.strength == 0 || misfit < best_.misfit) best_ = {possible(strength), misfit};
  }
  void refine() {
    for (const double factor : {1.2, 1.1, 1.05, 1.025, 1.0125}) {
      const double middle = best_.strength;
      keepIfNearer(middle * factor);
      keepIfNearer(middle / factor);
    }
  }

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_;
  const Model& base_;
  const OnSimulation& on_simulation_;
  Hypothesis& hypothesis_;
  Sensitivity& sensitivity_;
  Found best_;
};

/// Whether two changes are multiples of each other, up to a barely visible difference.
bool actAlike(const SharedVector& one, const SharedVector& other) {
  constexpr double parallel = 0.999;
  return one && other && std::abs(one->dot(*other)) > parallel * one->norm() * other->norm() && one->norm() > 0;
}

/// Drops signed strengths whose change is a small share of another strength's change, or a multiple of it: the recordings cannot determine
/// them, and a fit would give them arbitrary values.
void leaveOutIdle(const Comparison& comparison, Hypothesis& hypothesis, Sensitivity& sensitivity) {
  constexpr double small_share = 0.1;
  std::vector<double> excitation;
  for (const SharedVector& change : sensitivity.per_strength)
    excitation.push_back(change ? excitationRatio(comparison, *change) : std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = hypothesis.strengths().size(); k-- > 0;) {
    const int coordinate = hypothesis.strengths()[k];
    const bool idle = std::ranges::any_of(excitation, [&](double other) { return excitation[k] < small_share * other; });
    const auto before_k = sensitivity.per_strength.begin() + static_cast<std::ptrdiff_t>(k);
    const bool double_of_another =
        std::any_of(sensitivity.per_strength.begin(), before_k, [&](const SharedVector& other) { return actAlike(*before_k, other); });
    if (!(idle || double_of_another) || !hypothesis.isSigned(coordinate)) continue;
    hypothesis.leaveOut(coordinate);
    sensitivity.per_strength.erase(sensitivity.per_strength.begin() + static_cast<std::ptrdiff_t>(k));
    excitation.erase(excitation.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// Probes of delays and time constants, whose response is not proportional to them, and of sole strengths that seem useless: a tilt about
/// an axis in the plane of motion acts by its square, and a small one otherwise than the true one.
std::vector<Probe> lateProbes(const std::vector<Hypothesis>& hypotheses, const std::vector<Sensitivity>& sensitivities, double misfit) {
  std::vector<Probe> result;
  for (std::size_t s = 0; s < hypotheses.size(); ++s)
    for (std::size_t k = 0; k < hypotheses[s].strengths().size(); ++k) {
      const int coordinate = hypotheses[s].strengths()[k];
      const bool is_sole = hypotheses[s].strengths().size() == 1 && !sensitivities[s].from_threshold;
      const bool is_useless = is_sole && sensitivities[s].misfit > useless * misfit;
      if (hypotheses[s].info().stage == Stage::sensor) continue;
      if (!hypotheses[s].isTime(coordinate) && !is_useless) continue;
      addProbe(result, hypotheses[s], s, k, late);
    }
  return result;
}

/// Probes the hypotheses and adds the changes of the prediction to their sensitivities, per typical strength.
void probeInto(std::vector<Sensitivity>& sensitivities, const Comparison& comparison, const std::vector<Probe>& probes,
               const Eigen::VectorXd& nominal, const Model& base, int job_count, const OnSimulation& on_simulation) {
  parallelFor(static_cast<int>(probes.size()), job_count, [&](int i) {
    if (comparison.plant().interrupted()) return;
    const Probe& probe = probes[static_cast<std::size_t>(i)];
    Model model = base;
    model.effects.insert(model.effects.end(), probe.model.effects.begin(), probe.model.effects.end());
    for (const Probe::Target& target : probe.targets) {
      const Eigen::VectorXd predicted =
          target.signal < 0 ? comparison.predicted(model) : comparison.predictedInOne(target.signal, model, base);
      if (predicted.size() == nominal.size() && predicted.allFinite())
        sensitivities[target.hypothesis].per_strength[target.strength] = shared((predicted - nominal) / target.amount);
    }
    on_simulation();
  });
}

}  // namespace

std::vector<Sensitivity> changesOf(const Comparison& comparison, const std::vector<Hypothesis>& hypotheses, const Eigen::VectorXd& nominal,
                                   const Model& base, int job_count, const OnSimulation& on_simulation) {
  std::vector<Sensitivity> result(hypotheses.size());
  for (std::size_t s = 0; s < hypotheses.size(); ++s)
    result[s].per_strength.resize(std::max<std::size_t>(1, hypotheses[s].strengths().size()));
  probeInto(result, comparison, probes(comparison, hypotheses), nominal, base, job_count, on_simulation);
  return result;
}

std::vector<Sensitivity> sensitivitiesOf(const Comparison& comparison, std::vector<Hypothesis>& hypotheses, const Eigen::VectorXd& nominal,
                                         const Model& base, int job_count, const OnSimulation& on_simulation) {
  std::vector<Sensitivity> result = changesOf(comparison, hypotheses, nominal, base, job_count, on_simulation);
  const auto probe = [&](std::vector<Sensitivity>& into, const std::vector<Probe>& probes) {
    probeInto(into, comparison, probes, nominal, base, job_count, on_simulation);
  };
  for (Sensitivity& sensitivity : result)
    if (std::ranges::all_of(sensitivity.per_strength, [](const SharedVector& change) { return change != nullptr; })) {
      double& largest = sensitivity.excitation_ratio.emplace(0);
      for (const SharedVector& change : sensitivity.per_strength) largest = std::max(largest, excitationRatio(comparison, *change));
    }
  const Eigen::VectorXd residual = comparison.measured() - nominal;
  auto adaptOnlyStrengths = [&](const std::function<bool(std::size_t)>& chosen, const std::function<void(OnlyStrength&)>& adapted) {
    std::vector<std::size_t> chosen_indices;
    for (std::size_t s = 0; s < hypotheses.size(); ++s)
      if (hypotheses[s].info().stage != Stage::sensor && hypotheses[s].strengths().size() == 1 && chosen(s)) chosen_indices.push_back(s);
    parallelFor(static_cast<int>(chosen_indices.size()), job_count, [&](int i) {
      const std::size_t s = chosen_indices[static_cast<std::size_t>(i)];
      OnlyStrength only_strength(comparison, nominal, base, on_simulation, hypotheses[s], result[s]);
      adapted(only_strength);
    });
  };
  adaptOnlyStrengths([&](std::size_t s) { return result[s].per_strength.front() && !shows(comparison, hypotheses[s], 0, result[s]); },
                     [](OnlyStrength& it) { it.searchThreshold(); });
  for (const int direction : {1, -1}) probe(result, strongerProbes(comparison, hypotheses, result, direction));
  for (std::size_t s = 0; s < hypotheses.size(); ++s) leaveOutIdle(comparison, hypotheses[s], result[s]);
  constexpr int weakenings = 3;
  for (int i = 0; i < weakenings; ++i) probe(result, weakerProbes(comparison, hypotheses, result, residual));
  for (std::size_t s = 0; s < hypotheses.size(); ++s) fitLinearly(comparison, hypotheses[s], residual, result[s]);
  std::vector<Sensitivity> late_result = result;
  probe(late_result, lateProbes(hypotheses, result, comparison.misfit(residual)));
  for (std::size_t s = 0; s < hypotheses.size(); ++s) {
    fitLinearly(comparison, hypotheses[s], residual, late_result[s]);
    if (late_result[s].misfit < result[s].misfit) result[s] = std::move(late_result[s]);
  }
  adaptOnlyStrengths([](std::size_t) { return true; }, [](OnlyStrength& it) { it.relinearise(); });
  return result;
}

Eigen::VectorXd startOf(const Hypothesis& hypothesis, const Sensitivity& sensitivity, const std::vector<double>& amounts) {
  constexpr double least = 0.05;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis.coordinateCount());
  for (std::size_t k = 0; k < hypothesis.strengths().size(); ++k)
    z[hypothesis.strengths()[k]] = sensitivity.from_threshold ? 1 : std::abs(amounts[k]) < least ? least : amounts[k];
  return z;
}

}  // namespace musclesim
