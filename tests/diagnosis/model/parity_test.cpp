// What signals of motion contradict each other by: an elbow's angle, lengths and hand follow from one coordinate.
#include "diagnosis/model/parity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/fit/comparison.h"
#include "musclesim/base/random.h"

namespace musclesim {
namespace {

const std::vector<std::string> names = {"force_0_N", "angle_elbow_deg", "length_0_mm", "length_1_mm", "hand_x_mm", "hand_y_mm"};
const std::vector<double> sigmas = {0.5, 0.1, 0.1, 0.1, 0.3, 0.3};
const std::vector<int> motions = {1, 2, 3, 4, 5};

/// A recording of the elbow under antagonistic commands of an amplitude, without noise.
Recording elbowMoved(double amplitude) {
  Recording plan;
  plan.file = "plan.csv";
  plan.info.robot = "elbow";
  plan.signals = {{"command_0", {}}, {"command_1", {}}};
  for (int row = 0; row < 60; ++row) {
    const double t = 0.02 * row;
    plan.time_s.push_back(t);
    plan.signals[0].values.push_back(0.4 + amplitude * std::sin(5 * t));
    plan.signals[1].values.push_back(0.4 - amplitude * std::sin(5 * t));
  }
  Recording recording = replayRecording(plan, {}).simulated;
  recording.file = plan.file;
  for (std::size_t i = 0; i < names.size(); ++i) recording.info.noise_std[names[i]] = sigmas[i];
  return recording;
}

Eigen::VectorXd readings(const Recording& recording, std::size_t row) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(motions.size()));
  for (std::size_t i = 0; i < motions.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = recording.find(names[static_cast<std::size_t>(motions[i])])->values[row];
  return result;
}

double rmsInSigmas(const Eigen::VectorXd& of_motions) {
  double sum = 0;
  for (std::size_t i = 0; i < motions.size(); ++i)
    sum += std::pow(of_motions[static_cast<Eigen::Index>(i)] / sigmas[static_cast<std::size_t>(motions[i])], 2);
  return std::sqrt(sum / static_cast<double>(motions.size()));
}

TEST(Parity, AnotherMotionShowsLittleAndAFaultOfOneSensorShowsWhole) {
  const Recording measured = elbowMoved(0.2), other = elbowMoved(0.25);
  const ParityRelations parity(measured, {}, motions, names, sigmas);
  ASSERT_EQ(parity.count(), 4) << "five signals, one coordinate";
  double largest = 0;
  for (std::size_t row = 10; row < measured.time_s.size(); ++row) {
    const Eigen::VectorXd here = readings(measured, row), there = readings(other, row);
    const auto parityOf = [&](const Eigen::VectorXd& of) { return parity.at(static_cast<int>(row), of, here); };
    largest = std::max(largest, rmsInSigmas(here - there));
    EXPECT_LT(rmsInSigmas(parityOf(here) - parityOf(there)), 0.01 * rmsInSigmas(here - there) + 0.1) << "row " << row;
    Eigen::VectorXd biased = here;
    biased[0] += 1;  // degree
    EXPECT_GT((parityOf(biased) - parityOf(here))[0], 0.5) << "what remains of a bias of one degree beside four other signals, row " << row;
  }
  EXPECT_GT(largest, 30) << "the motions differ by much more than the noise";
}

/// An arm hangs down: its hand hardly moves up or down near this pose, but by a centimetre a little further away. A hand that is known to a
/// micrometre would determine the pose alone, and all other signals would seem to contradict it.
TEST(Parity, AnExactHandDoesNotDetermineThePoseOfAnotherMotion) {
  const auto hanging = [](double amplitude) {
    Recording plan;
    plan.info.robot = "pulley_arm";
    for (int muscle = 0; muscle < 6; ++muscle) plan.signals.push_back({"command_" + std::to_string(muscle), {}});
    for (int row = 0; row < 40; ++row) {
      plan.time_s.push_back(0.02 * row);
      for (std::size_t muscle = 0; muscle < 6; ++muscle)
        plan.signals[muscle].values.push_back(0.4 + (muscle % 2 == 0 ? amplitude : -amplitude) * std::sin(0.1 * row));
    }
    return replayRecording(plan, {}).simulated;
  };
  const std::vector<std::string> of_arm = {"angle_shoulder_deg", "angle_elbow_deg", "hand_x_mm", "hand_y_mm"};
  const Recording measured = hanging(0.02), other = hanging(0.1);
  const ParityRelations parity(measured, {}, {0, 1, 2, 3}, of_arm, {0.1, 0.1, 0.001, 0.001});
  ASSERT_EQ(parity.count(), 2);
  double largest_deg = 0;
  for (std::size_t row = 10; row < measured.time_s.size(); ++row) {
    Eigen::VectorXd here(4), there(4);
    for (Eigen::Index i = 0; i < 4; ++i) {
      here[i] = measured.find(of_arm[static_cast<std::size_t>(i)])->values[row];
      there[i] = other.find(of_arm[static_cast<std::size_t>(i)])->values[row];
    }
    const Eigen::VectorXd change = parity.at(static_cast<int>(row), there, here) - parity.at(static_cast<int>(row), here, here);
    largest_deg = std::max(largest_deg, (there - here).head(2).cwiseAbs().maxCoeff());
    EXPECT_LT(change.head(2).cwiseAbs().maxCoeff(), 0.3) << "degrees, row " << row;
  }
  EXPECT_GT(largest_deg, 5) << "the motions differ by much more";
}

TEST(Parity, KnowsTheVarianceOfItsNoise) {
  const Recording measured = elbowMoved(0.1);
  const ParityRelations parity(measured, {}, motions, names, sigmas);
  RandomStream random(3, "parity test");
  constexpr int draws = 4000, row = 30;
  const Eigen::VectorXd here = readings(measured, row);
  double square = 0;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd noise(static_cast<Eigen::Index>(motions.size()));
    for (Eigen::Index i = 0; i < noise.size(); ++i)
      noise[i] = sigmas[static_cast<std::size_t>(motions[static_cast<std::size_t>(i)])] * random.normal();
    square += std::pow((parity.at(row, here + noise, here) - parity.at(row, here, here))[0], 2) / draws;
  }
  EXPECT_NEAR(square, parity.noiseVariance(row, 0), 0.1 * square);
}

TEST(Parity, NeedsMoreSignalsThanCoordinatesAndADeterminedPose) {
  Recording measured = elbowMoved(0.1);
  EXPECT_EQ(ParityRelations(measured, {}, {1}, names, sigmas).count(), 0);
  std::erase_if(measured.signals, [](const Signal& signal) { return isMotion(signal.name); });
  EXPECT_EQ(ParityRelations(measured, {}, motions, names, sigmas).count(), 0) << "nothing tells the pose";
}

/// The angle reads a degree too much; the motion itself is as predicted.
TEST(Parity, IsAChannelOfItsOwn) {
  Recording measured = elbowMoved(0.2);
  std::erase_if(measured.signals, [](const Signal& signal) {
    return !signal.name.starts_with("command_") && std::ranges::find(names, signal.name) == names.end();
  });
  for (Signal& signal : measured.signals)
    if (signal.name == "angle_elbow_deg")
      for (double& value : signal.values) value += 1;
  Recording again = measured;
  again.file = "again.csv";
  again.signals[0].values[5] += 1e-3;  // the same recording twice is refused
  DiagnosisOptions options;
  const Plant plant({measured, again}, options);
  const Comparison comparison(plant, {{0, 0, 60}}, Comparison::Derived::with);
  double motion = 0, of_parity = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    const std::string& name = plant.signals()[static_cast<std::size_t>(block.signal)].name;
    if (block.is_parity)
      of_parity += block.power;
    else if (isMotion(name))
      motion += block.power;
  }
  const double as_recordings = 3;  // one recording counts as three
  EXPECT_NEAR(motion, as_recordings * 1, 1e-9) << "one coordinate";
  EXPECT_NEAR(of_parity, as_recordings * 4, 1e-9);
  const Eigen::VectorXd residual = comparison.measured() - comparison.predicted(Model{});
  for (const Comparison::Block& block : comparison.blocks())
    if (block.is_parity && block.averaged_rows == 0 && plant.signals()[static_cast<std::size_t>(block.signal)].name == "angle_elbow_deg") {
      EXPECT_GT(std::sqrt(comparison.meanSquare(block, residual)), 4 * block.sigma);
    }
  EXPECT_EQ(comparison.gap(residual).per_signal.size(), names.size()) << "the gap is that of the signals as recorded";
}

}  // namespace
}  // namespace musclesim
