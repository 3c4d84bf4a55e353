// Derivatives and intervals, and the last steps of a fit, on predictions without a simulation.
#include "diagnosis/fit/certainty.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../short_rig.h"
#include "diagnosis/fit/refit.h"

namespace musclesim {
namespace {

constexpr Eigen::Index row_count = 300;

class CertaintyOfAFit : public planted::ShortRig {
 protected:
  /// The measured values are those at `truth`, with noise of the size that is expected.
  FitProblem problem(const Predicted& moved, const Eigen::VectorXd& truth, const Eigen::VectorXd& start) const {
    FitProblem problem;
    problem.start = start;
    problem.clamped = [](const Eigen::VectorXd& z) { return z; };
    problem.predicted = [this, moved, truth](const Eigen::VectorXd& z) -> Eigen::VectorXd {
      return both.measured() + moved(z) - moved(truth) + noise();
    };
    return problem;
  }
  static Eigen::VectorXd noise() {
    Eigen::VectorXd result(row_count);
    for (Eigen::Index i = 0; i < row_count; ++i) result[i] = planted::noise_mm * std::sqrt(2) * std::sin(2.3 * static_cast<double>(i));
    return result;
  }
  Eigen::VectorXd residual(const FitProblem& problem, const Eigen::VectorXd& z) const { return both.measured() - problem.predicted(z); }
};

/// Steps of a command that come late, by 8 z_0 rows, and pass two lags of 5 exp(z_1) and 3 exp(z_2) rows: three changes much alike.
Eigen::VectorXd lateAndLagging(const Eigen::VectorXd& z) {
  constexpr double height_mm = 40;
  const double first = 5 * std::exp(z[1]), second = 3 * std::exp(z[2]);
  Eigen::VectorXd result(row_count);
  for (Eigen::Index i = 0; i < row_count; ++i) {
    const double t = std::max(0.0, static_cast<double>(i % 60) - 8 * z[0]);
    result[i] = height_mm * (1 - (first * std::exp(-t / first) - second * std::exp(-t / second)) / (first - second));
  }
  return result;
}

TEST_F(CertaintyOfAFit, StepsAsShortAsTheIntervalsTellApartWhatBends) {
  const Eigen::Vector3d truth(1, 0, 0);
  const FitProblem bent = problem(lateAndLagging, truth, truth);
  const Eigen::VectorXd left = residual(bent, truth);
  const FitPoint at = evaluate(both, bent, truth);
  const Eigen::MatrixXd wide = derivatives(both, bent, at, wide_difference), narrow = derivatives(both, bent, at, narrow_difference),
                        tangent = derivatives(both, bent, at, 1e-6);
  const Derivatives found = derivativesAt(both, bent, left);
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_LT((found.jacobian.col(k) - tangent.col(k)).norm(), 0.05 * tangent.col(k).norm());
  const Certainty certainty = certaintyOf(both, bent, at, found);
  EXPECT_NEAR(certainty.determined.sum(), 3, 1e-9);
  EXPECT_LT(certainty.half_width.maxCoeff(), 0.1);
  const Eigen::VectorXd difference = (wide - narrow).colwise().norm().cwiseQuotient(narrow.colwise().norm());
  EXPECT_LT(certaintyOf(both, bent, at, {narrow, difference.transpose()}).determined.sum(), 2.9) << "longer steps do not tell";
}

/// Away from the least squares of the readings, the half width grows by the distance.
TEST_F(CertaintyOfAFit, IntervalsReachTheLeastSquares) {
  constexpr double away = 0.01;
  const Predicted wave = [](const Eigen::VectorXd& z) -> Eigen::VectorXd {
    Eigen::VectorXd result(row_count);
    for (Eigen::Index i = 0; i < row_count; ++i) result[i] = z[0] * std::sin(0.1 * static_cast<double>(i));
    return result;
  };
  const Eigen::VectorXd truth = Eigen::VectorXd::Ones(1), beside = truth.array() + away;
  const FitProblem linear = problem(wave, truth, truth);
  const Derivatives derivatives = withoutErrors(both, wave(truth));
  const double there = certaintyOf(both, linear, evaluate(both, linear, truth), derivatives).half_width[0];
  const double half_width = certaintyOf(both, linear, evaluate(both, linear, beside), derivatives).half_width[0];
  EXPECT_GT(half_width, there + 0.9 * away);
  EXPECT_LT(half_width, 3 * (there + away));
}

/// Changes of less than 0.01 do nothing: so short a step says nothing, and the interval must not become narrower by it.
TEST_F(CertaintyOfAFit, StepsWithinDryFrictionAreNotTaken) {
  const Predicted rubbing = [](const Eigen::VectorXd& z) -> Eigen::VectorXd {
    const double moved = std::max(0.0, z[0] - 1.01);
    Eigen::VectorXd result(row_count);
    for (Eigen::Index i = 0; i < row_count; ++i) result[i] = 40 * (moved + 5 * moved * moved) * std::sin(0.1 * static_cast<double>(i));
    return result;
  };
  const Eigen::VectorXd truth = Eigen::VectorXd::Ones(1);
  const FitProblem dry = problem(rubbing, truth, truth);
  const Eigen::VectorXd left = residual(dry, truth);
  const Derivatives found = derivativesAt(both, dry, left);
  EXPECT_GT(found.jacobian.norm(), 0.5 * derivatives(both, dry, evaluate(both, dry, truth), narrow_difference).norm());
  EXPECT_TRUE(std::isfinite(certaintyOf(both, dry, evaluate(both, dry, truth), found).half_width[0]));
}

/// The pressure follows two coordinates smoothly. The length jumps with either of them, and much alike: it must not hide what the pressure
/// tells, nor seem to tell more by its jumps.
TEST(CertaintyOfSignals, ASignalThatJumpsHidesNothingThatAnotherOneTells) {
  constexpr double jump_mm = 2;
  const DiagnosisOptions options;
  const Plant plant(
      {planted::recorded({}, 0.1, 1, planted::Pressure::measured), planted::recorded({}, 0.13, 2, planted::Pressure::measured)}, options);
  const Comparison both(plant, {{0, 0, 150}, {1, 0, 150}});
  const auto predicted = [&both](double jump_of_length_mm) -> Predicted {
    return [&both, jump_of_length_mm](const Eigen::VectorXd& z) {
      Eigen::VectorXd result = both.measured();
      for (const Comparison::Block& block : both.blocks())
        for (Eigen::Index i = 0; i < block.count(); ++i) {
          const double phase = 0.1 * static_cast<double>(i);
          const double noise = block.sigma * std::sqrt(2) * std::sin(23 * phase);
          const double smooth = z[0] * std::sin(phase) + z[1] * std::cos(phase);
          const double jumping = std::sin(phase + 1000 * (z[0] + 1.01 * z[1])) - std::sin(phase);
          const bool is_pressure = both.plant().signals()[static_cast<std::size_t>(block.signal)].name == "pressure_0";
          result[block.first + i] += noise + (is_pressure ? 10 * block.sigma * smooth : jump_of_length_mm * jumping);
        }
      return result;
    };
  };
  const auto widthWith = [&](double jump_of_length_mm) {
    FitProblem problem;
    problem.start = Eigen::Vector2d::Zero();
    problem.clamped = [](const Eigen::VectorXd& z) { return z; };
    problem.predicted = predicted(jump_of_length_mm);
    const FitPoint at = evaluate(both, problem, problem.start);
    return certaintyOf(both, problem, at, derivativesAt(both, problem, at.residual)).half_width.maxCoeff();
  };
  const double smooth = widthWith(0), jumping = widthWith(jump_mm);
  EXPECT_LT(smooth, 0.1);
  EXPECT_LT(jumping, 1.2 * smooth);
  EXPECT_GT(jumping, 0.5 * smooth);
}

/// Half the time step changes the prediction as a shift of the coordinates would, so the whole step as twice that shift.
TEST_F(CertaintyOfAFit, IntervalsHoldWhatTheTimeStepChanges) {
  const Eigen::Vector3d truth(1, 0, 0), by_half_step(0.004, -0.002, 0.003);
  const FitProblem exact = problem(lateAndLagging, truth, truth);
  const Predicted finer = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return exact.predicted(z + by_half_step); };
  const Eigen::VectorXd left = residual(exact, truth);
  const FitResult without = finish(both, exact, exact.predicted, left), with = finish(both, exact, exact.predicted, left, finer);
  EXPECT_EQ(with.z, without.z) << "the intervals are widened, nothing is moved";
  const Eigen::VectorXd wider = with.certainty.half_width - without.certainty.half_width;
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(wider[k], 2 * std::abs(by_half_step[k]), 0.2 * std::abs(by_half_step[k])) << k;
}

/// A fit ends where another step gains little of the tempered misfit, which may be many standard errors from the truth. Only the exact
/// prediction has its least misfit there.
TEST_F(CertaintyOfAFit, TheLastStepsEndWithinTheInterval) {
  const Eigen::Vector3d truth(1, 0, 0), start(1.02, 0.1, -0.1);
  const FitProblem exact = problem(lateAndLagging, truth, start);
  FitProblem cheap = exact;
  cheap.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return exact.predicted(z + Eigen::Vector3d(0.02, 0.01, -0.01)); };
  const FitResult found = finish(both, cheap, exact.predicted, residual(exact, start));
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(found.z[k] - truth[k]), found.certainty.half_width[k]);
    EXPECT_GT(std::abs(start[k] - truth[k]), found.certainty.half_width[k]) << "the start is outside";
  }
  EXPECT_NEAR(found.cost, both.misfit(found.residual), 1e-12);
  EXPECT_LT((found.residual - residual(exact, found.z)).norm(), 1e-9) << "the residual is the exact one";
}

}  // namespace
}  // namespace musclesim
