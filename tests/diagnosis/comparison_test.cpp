// Residuals, their size, sensitivities and the fit, on short recordings of a rig.
#include "diagnosis/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/actuation_phases.h"
#include "diagnosis/drawing.h"
#include "diagnosis/refit.h"
#include "diagnosis/sensitivity.h"
#include "planted.h"
#include "tempered_misfit.h"

namespace musclesim {
namespace {

/// Two short recordings of a rig, both for fitting.
class Rig : public testing::Test {
 protected:
  explicit Rig(const std::vector<ActiveEffect>& effects = {}, double amplitude = 0.1)
      : plant({planted::recorded(effects, amplitude, 1), planted::recorded(effects, 1.3 * amplitude, 2)}, options),
        both(plant, {{0, 0, 150}, {1, 0, 150}}) {}

  DiagnosisOptions options;
  Plant plant;
  Comparison both;
};

TEST_F(Rig, MisfitIsZeroForNoiseAndGrowsWithTheLogarithmOfTheResidual) {
  ASSERT_EQ(both.blocks().size(), 2u);
  ASSERT_EQ(both.size(), 300);
  const double sigma = planted::noise_mm, power = 1.5;  // two recordings count as three
  EXPECT_NEAR(both.blocks()[0].sigma, sigma, 1e-12);
  EXPECT_NEAR(both.misfit(Eigen::VectorXd::Constant(300, sigma)), 0, 1e-12);
  EXPECT_NEAR(both.misfit(Eigen::VectorXd::Zero(300)), -power * natsPerFold() * std::log(2), 1e-12) << "nothing less than nothing left";
  Eigen::VectorXd residual = Eigen::VectorXd::Constant(300, sigma);
  residual.head(150) *= 3;
  residual.tail(150) *= 5;
  EXPECT_NEAR(both.misfit(residual), power * (temperedMisfit(3) + temperedMisfit(5)), 1e-9);
  EXPECT_NEAR(both.misfit(1e6 * std::exp(1) * residual) - both.misfit(1e6 * residual), 2 * power * natsPerFold(), 1e-6);
  EXPECT_TRUE(std::isinf(both.misfit({})));
  residual[0] = NAN;
  EXPECT_TRUE(std::isinf(both.misfit(residual)));
}

/// Residuals of 3 and 5 sigmas, gaps of 40 and 200.
TEST_F(Rig, MisfitToleratesASmallShareOfTheGap) {
  const double sigma = planted::noise_mm, power = 1.5;
  Eigen::VectorXd residual = Eigen::VectorXd::Constant(300, 3 * sigma), gap = Eigen::VectorXd::Constant(300, 40 * sigma);
  residual.tail(150).setConstant(5 * sigma);
  gap.tail(150).setConstant(-200 * sigma);
  const double untempered = both.misfit(residual);
  both.setGap(gap);
  EXPECT_NEAR(both.misfit(residual), power * (temperedMisfit(3, 40) + temperedMisfit(5, 200)), 1e-9);
  EXPECT_LT(both.misfit(residual), untempered);
  EXPECT_NEAR(both.misfit(Eigen::VectorXd::Constant(300, sigma)), 0, 1e-12);
  EXPECT_NEAR(both.misfitOf(both.blocks()[1], 25 * sigma * sigma), power * temperedMisfit(5, 200), 1e-9);
}

/// d(misfit) / d(r) = w^2 r for every row, by central differences.
TEST_F(Rig, WeightsAreTheSlopeOfTheMisfit) {
  const double sigma = planted::noise_mm;
  Eigen::VectorXd residual(300);
  for (Eigen::Index i = 0; i < 300; ++i) residual[i] = sigma * (2 + std::sin(0.1 * static_cast<double>(i)));
  residual.tail(150) *= 4;
  both.setGap(20 * residual);
  const Eigen::VectorXd weights = both.weights(residual);
  for (const Eigen::Index row : {0, 70, 149, 150, 299}) {
    const double step = 0.01 * sigma;
    Eigen::VectorXd more = residual, less = residual;
    more[row] += step;
    less[row] -= step;
    const double slope = (both.misfit(more) - both.misfit(less)) / (2 * step);
    EXPECT_NEAR(weights[row] * weights[row] * residual[row] / slope, 1, 1e-6) << row;
  }
  const Comparison::Block& block = both.blocks()[0];
  EXPECT_NEAR(both.weightSquare(block, both.meanSquare(block, residual)), 150 * weights[0] * weights[0], 1e-9 * weights[0] * weights[0]);
}

TEST_F(Rig, ScaleIsWhatAResidualOfOneFoldOfTheNoiseCosts) {
  EXPECT_NEAR(both.scale(), 2 * 1.5 * natsPerFold(), 1e-12);
}

/// Powers of the length, of the pressure, and of their averages: recordings and channels weigh alike however many signals they have.
TEST(SharesOfEvidence, AreEqualForChannelsAndForAtMostThreeRecordings) {
  const DiagnosisOptions options;
  const auto measured = [](double amplitude, std::uint64_t seed) {
    return planted::recorded({}, amplitude, seed, planted::Pressure::measured);
  };
  const Plant plant({measured(0.1, 1), measured(0.11, 2), measured(0.12, 3), measured(0.13, 4)}, options);
  const auto powers = [&](int recording_count, Comparison::Derived derived) {
    std::vector<Segment> segments;
    for (int recording = 0; recording < recording_count; ++recording) segments.push_back({recording, 0, 150});
    const Comparison comparison(plant, segments, derived);
    std::map<std::string, double> sums;
    for (const Comparison::Block& block : comparison.blocks())
      sums[plant.signals()[static_cast<std::size_t>(block.signal)].name] += block.power;
    return sums;
  };
  for (const Comparison::Derived derived : {Comparison::Derived::without, Comparison::Derived::with}) {
    for (const int recording_count : {1, 2, 3}) {
      EXPECT_NEAR(powers(recording_count, derived).at("length_0_mm"), 3, 1e-12) << recording_count;
      EXPECT_NEAR(powers(recording_count, derived).at("pressure_0"), 3, 1e-12) << recording_count;
    }
    EXPECT_NEAR(powers(4, derived).at("pressure_0"), 4, 1e-12);
  }
}

/// Two lengths, an angle and the hand of an elbow are functions of each other, but have sensors of their own.
TEST(SharesOfEvidence, OfSignalsOfMotionGrowWithTheRootOfTheirNumber) {
  Recording plan;
  plan.file = "elbow.csv";
  plan.info.robot = "elbow";
  plan.signals = {{"command_0", {}}, {"command_1", {}}};
  for (int row = 0; row < 60; ++row) {
    plan.time_s.push_back(0.01 * row);
    plan.signals[0].values.push_back(0.4 + 0.002 * row);
    plan.signals[1].values.push_back(0.4);
  }
  const DiagnosisOptions options;
  const Plant plant({replayRecording(plan).simulated}, options);
  const Comparison comparison(plant, {{0, 0, 60}});
  double motion = 0;
  std::size_t motion_count = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    const std::string& name = plant.signals()[static_cast<std::size_t>(block.signal)].name;
    if (name.starts_with("pressure_") || name.starts_with("force_")) {
      EXPECT_NEAR(block.power, 3, 1e-12) << name;
    } else {
      motion += block.power;
      ++motion_count;
    }
  }
  EXPECT_GT(motion_count, 3u);
  EXPECT_NEAR(motion, 3 * std::sqrt(static_cast<double>(motion_count)), 1e-12);
}

/// In turn: a reading per row, a reading held for four rows, a reading held throughout, a third of the rows without a number.
TEST(AveragedShareOfSigma, CountsReadingsNotRows) {
  auto every = [](int held) {
    std::vector<double> values;
    for (int row = 0; row < 960; ++row) values.push_back(row / held);  // whole numbers
    return values;
  };
  auto share = [](double readings) { return std::sqrt(1 / readings + steady_share * steady_share); };
  EXPECT_NEAR(averagedShareOfSigma(every(1)), share(averaging_rows), 1e-12);
  EXPECT_NEAR(averagedShareOfSigma(every(4)), share(averaging_rows / 4.0), 1e-12);
  EXPECT_NEAR(averagedShareOfSigma(every(960)), share(1), 1e-12);
  std::vector<double> with_gaps = every(1);
  for (std::size_t row = 0; row < with_gaps.size(); row += 3) with_gaps[row] = NAN;
  EXPECT_NEAR(averagedShareOfSigma(with_gaps), share(averaging_rows), 1e-12);
  EXPECT_NEAR(averagedShareOfSigma({}), share(1), 1e-12);
}

/// Makes coarse steps differ from all others by 100 sigmas.
TEST_F(Rig, SaysWhatStepsChangeWhereCoarserOnesFollowAnotherMotion) {
  const Eigen::VectorXd nominal = both.predicted(Model{});
  both.goCoarse(nominal);
  EXPECT_TRUE(both.unsteady().signal.empty());
  both.goCoarse(nominal + Eigen::VectorXd::Constant(300, 100 * planted::noise_mm));
  EXPECT_EQ(both.unsteady().signal, "length_0_mm");
  EXPECT_NEAR(both.unsteady().in_sigmas, 100, 1);
  EXPECT_NEAR(both.unsteady().share_of_gap, 1, 0.05);
}

TEST_F(Rig, NumbersThatNeedFarMoreStepsAreRefused) {
  Recording machine = planted::recorded({}, 0.1, 1);
  machine.info.extra_json = "{}";  // a measured recording's model takes as many as it needs
  Recording other = planted::recorded({}, 0.1, 2);
  other.info.extra_json = "{}";
  const Plant measured({machine, other}, options);
  EXPECT_FALSE(measured.predict(0, Model{{}, {{"force_law.b", 9}}}).refused);
  EXPECT_TRUE(measured.predict(0, Model{{}, {{"force_law.b", 40}}}).refused) << "a force of e^40 would take hours";
}

TEST_F(Rig, GapIsTheMeanSquareBeyondTheFloorInUnitsOfTheFloor) {
  const Gap gap = both.gap(Eigen::VectorXd::Constant(300, 3 * planted::noise_mm));
  EXPECT_NEAR(gap.normalised, 8, 1e-9);
  EXPECT_NEAR(gap.per_signal.at("length_0_mm").rmse, 3 * planted::noise_mm, 1e-12);
  EXPECT_EQ(both.gap(Eigen::VectorXd::Constant(300, 0.9 * planted::noise_mm)).normalised, 0);
}

TEST_F(Rig, ActuationPhasesFollowTheCommand) {
  // The first recording steps between 0.55 and 0.35 every half second from 0.55 at the start.
  const Comparison first(plant, {{0, 0, 200}});
  const PhaseSums sums = phaseSums(first, Eigen::VectorXd::Constant(200, 2 * planted::noise_mm));
  // A step counts for a tenth of a second: falls at 0.5 and 1.5 s, a rise at 1 s.
  EXPECT_EQ(sums.rows[static_cast<std::size_t>(ActuationPhase::venting)], 20);
  EXPECT_EQ(sums.rows[static_cast<std::size_t>(ActuationPhase::filling)], 10);
  EXPECT_EQ(sums.rows[static_cast<std::size_t>(ActuationPhase::holding)], 170);
  for (const ActuationPhase phase : {ActuationPhase::filling, ActuationPhase::venting, ActuationPhase::holding})
    EXPECT_NEAR(sums.meanSquare(phase), 4, 1e-9);
}

/// If rows are further apart than the window of the phases, the row before counts.
TEST(ActuationPhases, FollowTheCommandInSparseRows) {
  Recording sparse;
  sparse.file = "sparse.csv";
  sparse.info.robot = "rig";
  sparse.signals = {{"command_0", {}}, {"length_0_mm", {}}};
  for (int row = 0; row < 100; ++row) {
    sparse.time_s.push_back(0.2 * row);
    sparse.signals[0].values.push_back(0.3 + 0.2 * std::sin(0.2 * row));
    sparse.signals[1].values.push_back(230 + std::sqrt(row));
  }
  const DiagnosisOptions options;
  const Plant plant({sparse}, options);
  const Comparison comparison(plant, {{0, 0, 100}});
  const PhaseSums sums = phaseSums(comparison, Eigen::VectorXd::Ones(100));
  EXPECT_GT(sums.rows[static_cast<std::size_t>(ActuationPhase::filling)], 30);
  EXPECT_GT(sums.rows[static_cast<std::size_t>(ActuationPhase::venting)], 30);
}

/// A problem without a simulation: the measured values are reached at z = (2, -1) along two directions, one of them curved.
TEST_F(Rig, FitFindsTheBottomOfABentValley) {
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

TEST_F(Rig, AveragesShowWhatIsWeakButSlow) {
  const Comparison averaged(plant, {{0, 0, 150}, {1, 0, 150}}, Comparison::Derived::with);
  ASSERT_EQ(averaged.blocks().size(), 4u);
  ASSERT_EQ(averaged.size(), 300 + 2 * 9) << "blocks of 16 rows, the rest left out";
  const Comparison::Block& blocks = averaged.blocks()[2];
  const double sigma = planted::noise_mm, block_sigma = sigma * std::sqrt(1.0 / 16 + 0.04);
  EXPECT_NEAR(blocks.sigma, block_sigma, 1e-12);
  EXPECT_NEAR(averaged.measured()[blocks.first], both.measured().head(16).mean(), 1e-12);
  EXPECT_EQ(averaged.predicted(Model{}).head(300), both.predicted(Model{}));
  const Eigen::VectorXd weak = Eigen::VectorXd::Constant(averaged.size(), 0.9 * sigma);
  const double half_power = 0.75;  // two recordings count as three; rows and averages share
  EXPECT_NEAR(averaged.misfit(weak), 2 * half_power * (temperedMisfit(0.9) + temperedMisfit(0.9 * sigma / block_sigma)), 1e-9);
  EXPECT_LT(both.misfit(weak.head(300)), 0) << "as recorded it is below the noise";
  EXPECT_GT(averaged.misfit(weak), 0.3 * averaged.scale());
  EXPECT_EQ(averaged.gap(2 * weak).normalised, both.gap(2 * weak.head(300)).normalised) << "the gap is that of the signals as recorded";
}

/// The cheap prediction has an error that depends on z; only the exact one has its minimum at 2.
TEST_F(Rig, CorrectedFitEndsWhereTheExactPredictionDoes) {
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
TEST_F(Rig, IntervalsOfWhatTheDataDoNotDetermineAreUnbounded) {
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

TEST_F(Rig, FitStaysWithinBoundsAndReportsADivergedStart) {
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
class PriorOnARig : public Rig {
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

TEST_F(PriorOnARig, NarrowsTheInterval) {
  EXPECT_LT(fit(both, problem(1e6), 20).certainty.half_width[0], 1.97e-3) << "1.96 standard deviations of the prior";
  EXPECT_GT(fit(both, problem(0), 20).certainty.half_width[0], 0.01);
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

class LoadedRig : public Rig {
 protected:
  LoadedRig() : Rig({{"payload", "hand", {{"mass_kg", 0.1}}}}, 0.05) {}
};

TEST_F(LoadedRig, FirstLookSeesThePayload) {
  options.candidates = {"payload", "valve_lag"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  int simulations = 0;
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [&] { ++simulations; });
  EXPECT_GT(simulations, 1);
  const double before = both.misfit(both.measured() - nominal);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].info().id == "payload") {
      EXPECT_LT(sensitivities[i].misfit, 0.4 * before);
      const auto values = all[i].valuesAt(sensitivities[i].amount);
      EXPECT_NEAR(values.front().second, 0.1, 0.03);
    } else {
      EXPECT_GT(sensitivities[i].misfit, 0.8 * before);
    }
  }
}

class SlightlyDampedRig : public Rig {
 protected:
  SlightlyDampedRig() : Rig({{"viscous_loss", "muscle_0", {{"damping_Ns_per_m", damping}}}}, 0.05) {}
  static constexpr double damping = 3;  // the first look begins at 245
};

TEST_F(SlightlyDampedRig, StrengthsThatDoTooMuchAreWeakened) {
  options.candidates = {"viscous_loss"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const double typical = all.front().valuesAt(all.front().typical()).front().second;
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  Eigen::VectorXd z = Eigen::VectorXd::Zero(all.front().coordinateCount());
  z[all.front().strengths().front()] = 1;
  EXPECT_LT(all.front().valuesAt(z).front().second, 0.1 * typical);
  z[all.front().strengths().front()] = sensitivities.front().amount[0];
  EXPECT_NEAR(all.front().valuesAt(z).front().second, damping, 0.5 * damping);
  EXPECT_LT(sensitivities.front().misfit, 0.6 * both.misfit(both.measured() - nominal));
}

class PushedRig : public Rig {
 protected:
  PushedRig() : Rig({{"external_force", "hand", {{"force_y_N", -2.0}}}}, 0.05) {}
};

/// The load of the rig moves up and down only.
TEST_F(PushedRig, StrengthsThatDoNothingAreLeftOut) {
  options.candidates = {"external_force"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  ASSERT_EQ(all.front().coordinateCount(), 3);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  ASSERT_EQ(all.front().coordinateCount(), 1);
  EXPECT_EQ(sensitivities.front().per_strength.size(), 1U);
  const auto values = all.front().valuesAt(sensitivities.front().amount);
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values.front().first, "force_y_N");
  EXPECT_NEAR(values.front().second, -2, 0.5);
}

class TiltedRig : public Rig {
 protected:
  TiltedRig() : Rig({{"base_tilt", "base", {{"tilt_z_deg", 6.0}}}}, 0.05) {}
};

/// On the rig a tilt to the front and one to the side act alike, in either direction: one of them is kept, and it explains the gap.
TEST_F(TiltedRig, OfStrengthsThatActAlikeOneIsLeft) {
  options.candidates = {"base_tilt"};
  std::vector<Hypothesis> all = hypotheses(plant, options), fresh = all;
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  ASSERT_EQ(all.front().coordinateCount(), 1);
  const double before = both.misfit(both.measured() - nominal);
  EXPECT_LT(sensitivities.front().misfit, 0.2 * before);
  std::vector<Sensitivity> of_all = changesOf(both, fresh, nominal, Model{}, 1, [] {});
  ASSERT_GT(of_all.front().per_strength.size(), 1U);
  fitLinearly(both, fresh.front(), both.measured() - nominal, of_all.front());
  EXPECT_LT(of_all.front().misfit, 0.2 * before) << "two that act alike do not drive each other against their bounds";
}

class AnotherLaw : public Rig {
 protected:
  AnotherLaw() : Rig({{"force_law", "muscle_0", law}}, 0.05) {}
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

TEST(Drawing, ShowsMusclesBonesAndJoints) {
  Simulation simulation;
  simulation.build("elbow");
  const RobotDrawing drawing = drawingOf(simulation);
  int muscles = 0, bones = 0;
  for (const RobotDrawing::Line& line : drawing.lines) (line.component.empty() ? bones : muscles) += 1;
  EXPECT_EQ(muscles, 2);
  EXPECT_GE(bones, 1);  // the upper arm is the environment
  ASSERT_FALSE(drawing.points.empty());
  EXPECT_EQ(drawing.points.front().component, "joint_elbow");
}

}  // namespace
}  // namespace musclesim
