// Residuals and their size, on short recordings of a rig.
#include "diagnosis/fit/comparison.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "../short_rig.h"
#include "../tempered_misfit.h"
#include "diagnosis/isolation/actuation_phases.h"
#include "diagnosis/model/drawing.h"
#include "effect/components.h"

namespace musclesim {
namespace {

using Rig = planted::ShortRig;

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

/// Then a reading three noise floors off costs (9 - 1) / 2 nats whatever the gap, and weights are those of plain least squares.
TEST_F(Rig, MisfitWithoutTemperingIsThatOfGaussianNoise) {
  const double sigma = planted::noise_mm;
  options.left_out = {MethodPart::tempering};
  Comparison plain(plant, {{0, 0, 150}, {1, 0, 150}});
  Eigen::VectorXd residual = Eigen::VectorXd::Constant(300, sigma);
  EXPECT_NEAR(plain.misfit(residual), 0, 1e-9);
  residual[7] = 3 * sigma;
  plain.setGap(100 * residual);
  EXPECT_NEAR(plain.misfit(residual), 4, 1e-9);
  EXPECT_NEAR(plain.weights(residual)[7], 1 / sigma, 1e-9 / sigma);
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
  EXPECT_EQ(both.unsteady().all_in_sigmas.at("length_0_mm"), both.unsteady().in_sigmas);
}

TEST_F(Rig, WhatTheStepChangesCountsAsNoiseWhereTheModelIsUnsteady) {
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const double sigma = both.blocks().front().sigma;
  both.goCoarse(nominal);
  EXPECT_EQ(both.blocks().front().sigma, sigma);
  const Eigen::VectorXd other_motion = nominal + Eigen::VectorXd::Constant(300, 100 * planted::noise_mm);
  both.goCoarse(other_motion);
  const double change = std::sqrt(both.meanSquare(both.blocks().front(), other_motion - both.predicted(Model{}, Fidelity::medium)));
  EXPECT_NEAR(change, 100 * planted::noise_mm, planted::noise_mm);
  EXPECT_NEAR(both.blocks().front().sigma, std::hypot(sigma, change), 1e-12);
}

/// An undamped elbow of massless muscles for 12 s; commands of both muscles from the number of the row.
Recording ofLightElbow(const std::function<std::array<double, 2>(int row)>& commands) {
  Recording plan;
  plan.info.robot = "elbow";
  plan.info.robot_parameters = {{"muscle.model", std::string("line")}};
  plan.signals = {{"command_0", {}}, {"command_1", {}}};
  for (int row = 0; row < 1200; ++row) {
    plan.time_s.push_back(0.01 * row);
    const auto [one, other] = commands(row);
    plan.signals[0].values.push_back(one);
    plan.signals[1].values.push_back(other);
  }
  Recording recording = replayRecording(plan, {}).simulated;
  recording.info.noise_std = {{"angle_elbow_deg", 0.05}};
  std::erase_if(recording.signals, [](const Signal& s) { return !s.name.starts_with("command_") && s.name != "angle_elbow_deg"; });
  return recording;
}

TEST(SensitiveMotion, CountsAsNoiseWhatSlightlyStrongerMusclesChange) {
  std::vector<std::array<double, 2>> drawn;
  RandomStream random(5, "commands");
  for (int k = 0; k < 30; ++k) drawn.push_back({random.uniform(), random.uniform()});
  const auto jumping = [&](int row) { return drawn[static_cast<std::size_t>(row / 40)]; };
  const auto gentle = [](int row) {
    const double wave = 0.1 * std::sin(0.01 * row);
    return std::array{0.6 + wave, 0.2 - wave};
  };
  for (const bool jumps : {true, false}) {
    const auto commands = [&](int row) { return jumps ? jumping(row) : gentle(row); };
    const DiagnosisOptions options;
    const Plant plant({ofLightElbow(commands), ofLightElbow([&](int row) { return commands(row / 2); })}, options);
    Comparison all(plant, {{0, 0, 1200}});
    const double sigma = all.blocks().front().sigma;
    all.goCoarse(all.predicted(Model{}));
    EXPECT_EQ(all.unsteady().signal, jumps ? "angle_elbow_deg" : "");
    EXPECT_EQ(all.blocks().front().sigma > 5 * sigma, jumps);
    if (!jumps) {
      EXPECT_EQ(all.blocks().front().sigma, sigma);
    }
    if (jumps) {
      EXPECT_EQ(all.unsteady().by, Unsteady::Change::forces);
    }
  }
}

/// A sensor that is read in every tenth row, but not in the first of ten.
TEST_F(Rig, OfThinnedRowsTheFirstWithAReadingIsCompared) {
  Recording sparse = planted::recorded({}, 0.1, 1);
  for (Signal& signal : sparse.signals)
    if (signal.name == "length_0_mm")
      for (std::size_t row = 0; row < signal.values.size(); ++row)
        if (row % 10 != 7) signal.values[row] = NAN;
  const Plant of_sparse({sparse, planted::recorded({}, 0.1, 2)}, options);
  const Comparison thinned(of_sparse, {{0, 0, 200, 10}});
  ASSERT_EQ(thinned.blocks().size(), 1u);
  EXPECT_EQ(thinned.blocks()[0].rows.front(), 7);
  EXPECT_EQ(thinned.blocks()[0].rows.size(), 20u);
  EXPECT_EQ(Comparison(of_sparse, {{1, 0, 200, 10}}).blocks()[0].rows[1], 10);
}

/// One simulation in which all sensors are late tells what each late sensor alone changes, also in what the others contradict it by.
TEST(PredictedInOne, IsThePredictionOfOneFaultySensor) {
  std::vector<Recording> recordings;
  for (const int speed : {1, 2}) {
    Recording plan;
    plan.info.robot = "elbow";
    plan.info.robot_parameters = {{"muscle.model", std::string("line")}};
    plan.signals = {{"command_0", {}}, {"command_1", {}}};
    for (int row = 0; row < 300; ++row) {
      plan.time_s.push_back(0.01 * row);
      const double wave = 0.1 * std::sin(0.05 * speed * row);
      plan.signals[0].values.push_back(0.5 + wave);
      plan.signals[1].values.push_back(0.3 - wave);
    }
    recordings.push_back(replayRecording(plan, {}).simulated);
    recordings.back().info.noise_std = {{"angle_elbow_deg", 0.05}, {"length_0_mm", 0.05}, {"length_1_mm", 0.05}};
    std::erase_if(recordings.back().signals, [](const Signal& s) {
      return s.name.starts_with("pressure_") || s.name.starts_with("force_") || s.name.starts_with("hand_");
    });
  }
  const DiagnosisOptions options;
  const Plant plant(recordings, options);
  const Comparison all(plant, {{0, 0, 300}, {1, 0, 300}}, Comparison::Derived::with);
  ASSERT_TRUE(std::ranges::any_of(all.blocks(), &Comparison::Block::is_parity));
  const auto late = [](const std::string& name) { return ActiveEffect{"sensor_delay", "signal_" + name, {{"delay_s", 0.05}}}; };
  const Model base{{{"payload", "hand", {{"mass_kg", 0.2}}}}, {}};
  Model faulty = base;
  for (const ComparedSignal& signal : plant.signals()) faulty.effects.push_back(late(stemOf(signal.name)));
  for (int s = 0; s < static_cast<int>(plant.signals().size()); ++s) {
    Model one = base;
    one.effects.push_back(late(stemOf(plant.signals()[static_cast<std::size_t>(s)].name)));
    EXPECT_EQ(all.predictedInOne(s, faulty, base), all.predicted(one)) << s;
    EXPECT_NE(all.predictedInOne(s, faulty, base), all.predicted(faulty)) << s;
  }
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
