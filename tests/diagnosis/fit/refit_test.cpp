// The fit, on short recordings of a rig.
#include "diagnosis/fit/refit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../short_rig.h"
#include "diagnosis/fit/sensitivity.h"

namespace musclesim {
namespace {

class Refit : public planted::ShortRig {};

/// A problem without a simulation: the measured values are reached at z = (2, -1) along two directions, one of them curved.
TEST_F(Refit, FindsTheBottomOfABentValley) {
  Eigen::VectorXd first(300), second(300);
  for (Eigen::Index i = 0; i < 300; ++i) {
    first[i] = std::sin(0.1 * static_cast<double>(i));
    second[i] = std::cos(0.03 * static_cast<double>(i));
  }
  auto moved = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return first * (z[0] + 0.2 * z[0] * z[0]) + second * z[1]; };
  const Eigen::VectorXd truth = Eigen::Vector2d(2, -1);
  FitProblem problem;
  problem.start = Eigen::Vector2d(0.5, 0.1);
  problem.clamped = [](const Eigen::VectorXd& z) -> Eigen::VectorXd { return z.cwiseMax(-3).cwiseMin(3); };
  problem.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return both.measured() + moved(z) - moved(truth); };
  const FitResult found = fit(both, problem, 20);
  EXPECT_NEAR(found.z[0], 2, 0.05);
  EXPECT_NEAR(found.z[1], -1, 0.05);
  EXPECT_LT(found.cost, 0.1) << "as little as noise";
}

/// The cheap prediction has an error that depends on z; only the exact one has its minimum at 2.
TEST_F(Refit, CorrectedEndsWhereTheExactPredictionDoes) {
  int exact_count = 0;
  Eigen::VectorXd shape(300);
  for (Eigen::Index i = 0; i < 300; ++i) shape[i] = 20 * std::sin(0.1 * static_cast<double>(i));
  FitProblem cheap;
  cheap.start = Eigen::VectorXd::Constant(1, 1.5);
  cheap.clamped = [](const Eigen::VectorXd& z) { return z; };
  cheap.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return both.measured() + shape * (0.9 * z[0] - 1); };
  auto exact = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd {
    ++exact_count;
    return both.measured() + shape * (z[0] - 2);
  };
  const FitResult found = fitCorrected(both, cheap, exact, 5);
  EXPECT_NEAR(found.z[0], 2, 0.02);
  EXPECT_LT((found.residual - shape * (2 - found.z[0])).norm(), 1e-9) << "the residual is the exact one";
  EXPECT_LE(exact_count, 3);
  EXPECT_GT(found.certainty.half_width[0], 0);
}

/// One coordinate has no influence, two act alike, and one is independent.
TEST_F(Refit, IntervalsOfWhatTheDataDoNotDetermineAreUnbounded) {
  FitProblem problem;
  problem.start = Eigen::VectorXd::Constant(4, 0.5);
  problem.clamped = [](const Eigen::VectorXd& z) { return z; };
  problem.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd {
    Eigen::VectorXd change(300);
    for (Eigen::Index i = 0; i < 300; ++i) {
      const auto t = static_cast<double>(i);
      change[i] = 5 * (z[1] + z[2] - 2) * std::sin(0.1 * t) + 5 * (z[3] - 1) * std::cos(0.03 * t) + 0.2 * std::sin(7 * t);
    }
    return both.measured() + change;
  };
  const FitResult found = fit(both, problem, 8);
  EXPECT_TRUE(std::isinf(found.certainty.half_width[0]));
  EXPECT_TRUE(std::isinf(found.certainty.half_width[1]));
  EXPECT_TRUE(std::isinf(found.certainty.half_width[2]));
  EXPECT_NEAR(found.certainty.determined.sum(), 2, 1e-9) << "the sum of two coordinates, and one";
  EXPECT_GT(found.certainty.half_width[3], 0);
  EXPECT_LT(found.certainty.half_width[3], 0.1);
  EXPECT_NEAR(found.z[3], 1, 0.1);
}

TEST_F(Refit, StaysWithinBoundsAndReportsADivergedStart) {
  FitProblem problem;
  problem.start = Eigen::VectorXd::Constant(1, 0.1);
  problem.clamped = [](const Eigen::VectorXd& z) -> Eigen::VectorXd { return z.cwiseMax(0).cwiseMin(1); };
  problem.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd {
    return both.measured() + Eigen::VectorXd::Constant(300, 4 - 2 * z[0]);
  };
  EXPECT_EQ(fit(both, problem, 10).z[0], 1);
  problem.predicted = [](const Eigen::VectorXd&) { return Eigen::VectorXd{}; };
  const FitResult diverged = fit(both, problem, 10);
  EXPECT_EQ(diverged.residual.size(), 0);
  EXPECT_TRUE(std::isinf(diverged.cost));
}

/// One coordinate moves the prediction along a wave: its cost is least at 2 without a prior.
class PriorOnARig : public planted::ShortRig {
 protected:
  FitProblem problem(double precision) const {
    FitProblem problem;
    problem.start = Eigen::VectorXd::Constant(1, 1);
    problem.clamped = [](const Eigen::VectorXd& z) { return z; };
    problem.predicted = [this](const Eigen::VectorXd& z) -> Eigen::VectorXd { return both.measured() - left(z[0]); };
    problem.precision = Eigen::VectorXd::Constant(1, precision);
    return problem;
  }
  Eigen::VectorXd left(double z) const {
    Eigen::VectorXd wave(300);
    for (Eigen::Index i = 0; i < 300; ++i) {
      const auto t = static_cast<double>(i);
      wave[i] = planted::noise_mm * (5 * (2 - z) * std::sin(0.1 * t) + std::sqrt(2) * std::sin(2 * t));
    }
    return wave;
  }
  double costAt(double z, double precision) const { return both.misfit(left(z)) + precision * z * z / 2; }
};

TEST_F(PriorOnARig, PullsTheFitToItsOwnLeastCost) {
  for (const double precision : {0.0, 1.0, 10.0, 50.0}) {
    double least = 0;
    for (double z = 0; z <= 2.5; z += 0.001)
      if (costAt(z, precision) < costAt(least, precision)) least = z;
    const FitResult found = fit(both, problem(precision), 20);
    EXPECT_NEAR(found.cost, costAt(found.z[0], precision), 1e-9);
    EXPECT_LT(found.cost, costAt(least, precision) + 0.05) << precision;
    if (precision == 0) {
      EXPECT_NEAR(least, 2, 0.01);
    } else if (precision == 50) {
      EXPECT_LT(least, 1.9) << "the prior is felt";
    }
  }
}

/// The prior agrees with the data here, so that two ways to weigh them do not differ.
TEST_F(PriorOnARig, NarrowsTheInterval) {
  const auto half_width = [this](double precision) {
    FitProblem agreeing = problem(precision);
    agreeing.start.setZero();
    agreeing.predicted = [this](const Eigen::VectorXd& z) -> Eigen::VectorXd { return both.measured() - left(2 + z[0]); };
    return fit(both, agreeing, 20).certainty.half_width[0];
  };
  EXPECT_LT(half_width(1e6), 1.97e-3) << "1.96 standard deviations of the prior";
  EXPECT_GT(half_width(0), 0.01);
}

/// Derivatives that are known need no prediction; those of renewed coordinates are computed when a step gains nothing.
TEST_F(PriorOnARig, KnownDerivativesAreUsedAndRenewedWhereAllowed) {
  int predictions = 0;
  FitProblem known = problem(0);
  const Predicted predicted = known.predicted;
  known.predicted = [&](const Eigen::VectorXd& z) {
    ++predictions;
    return predicted(z);
  };
  const Eigen::VectorXd derivative = left(0) - left(1);
  known.known_derivatives = {std::make_shared<const Eigen::VectorXd>(derivative)};
  known.renewed_count = 0;
  known.narrow_differences = false;
  EXPECT_NEAR(fit(both, known, 1).z[0], 2, 0.05);
  EXPECT_EQ(predictions, 2) << "the start and one step";
  known.known_derivatives = {std::make_shared<const Eigen::VectorXd>(-derivative)};
  EXPECT_EQ(fit(both, known, 8).z[0], 1) << "no step the wrong way is taken";
  known.renewed_count = -1;
  EXPECT_NEAR(fit(both, known, 8).z[0], 2, 0.05);
}

/// The prediction is linear in the coordinate, so that the first derivatives promise just what the fit can reach.
TEST_F(PriorOnARig, AFitEndsAfterOneStepIfItsLeastCostIsTooLarge) {
  const double least = fit(both, problem(0), 20).cost;
  int predictions = 0;
  FitProblem limited = problem(0);
  const Predicted predicted = limited.predicted;
  limited.predicted = [&](const Eigen::VectorXd& z) {
    ++predictions;
    return predicted(z);
  };
  limited.largest_cost = least + 0.1;
  EXPECT_NEAR(fit(both, limited, 20).z[0], 2, 0.01);
  limited.largest_cost = least - 0.1;
  predictions = 0;
  fit(both, limited, 20);
  EXPECT_EQ(predictions, 3) << "the start, the derivative, and one step";
}

class AnotherLaw : public planted::ShortRig {
 protected:
  AnotherLaw() : ShortRig({{"force_law", "muscle_0", law}}, 0.05) {}
  static inline const std::map<std::string, Parameter::Value> law = {
      {"law", std::string("corrected")}, {"bore_N", -1.0}, {"braid_N", -1.9}, {"stretch_N", 0.15}, {"threshold_N", 0.05}};
};

/// Dry friction in the muscle hides small changes, so derivatives from small differences are useless.
TEST_F(AnotherLaw, IsFittedThroughDryFriction) {
  options.candidates = {"force_law"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  FitProblem problem;
  problem.start = Eigen::VectorXd::Constant(all.front().coordinateCount(), -0.3);
  problem.clamped = [&](const Eigen::VectorXd& z) { return all.front().clamped(z); };
  problem.predicted = [&](const Eigen::VectorXd& z) { return both.predicted(Model{{all.front().at(z)}, {}}); };
  const double before = both.misfit(both.measured() - nominal);
  EXPECT_GT(before, both.scale());
  EXPECT_LT(fit(both, problem, 8).cost, 0.1 * before);
}

}  // namespace
}  // namespace musclesim
