#include "diagnosis/data/noise_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "musclesim/base/random.h"

namespace musclesim {
namespace {

constexpr double std_mm = 0.2;

/// A slow wave with normal noise, 20 s at 100 Hz.
Recording noisyWave(std::uint64_t seed, double command = 0.5) {
  RandomStream random(seed, "noise_floor_test");
  Recording recording;
  recording.info.robot = "rig";
  recording.signals = {{"command_0", {}}, {"length_0_mm", {}}};
  for (int row = 0; row < 2000; ++row) {
    recording.time_s.push_back(0.01 * row);
    recording.signals[0].values.push_back(command);
    recording.signals[1].values.push_back(200 + 20 * std::sin(0.01 * row) + std_mm * random.normal());
  }
  return recording;
}

TEST(NoiseSigma, ComesFromRepeatsFirst) {
  std::vector<Recording> repeats = {noisyWave(1), noisyWave(2)};
  repeats[0].info.noise_std["length_0_mm"] = 5;
  const NoiseSigma sigma = noiseSigma(repeats, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::repeats);
  EXPECT_NEAR(sigma.value, std_mm, 0.05 * std_mm);
}

TEST(NoiseSigma, RepeatsThatAreCalledSoNeedNotHaveTheSameTimes) {
  std::vector<Recording> repeats = {noisyWave(1), noisyWave(2)};
  repeats[0].file = "folder/first.csv";
  for (double& time_s : repeats[1].time_s) time_s += 0.004;
  EXPECT_NE(noiseSigma(repeats, "length_0_mm").source, NoiseSigma::Source::repeats);
  repeats[1].info.repeat_of = "first";
  const NoiseSigma sigma = noiseSigma(repeats, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::repeats);
  EXPECT_NEAR(sigma.value, std_mm, 0.1 * std_mm);
}

TEST(NoiseSigma, ThenFromTheSidecar) {
  std::vector<Recording> recordings = {noisyWave(1, 0.4), noisyWave(2, 0.6)};
  recordings[0].info.noise_std["length_0_mm"] = 0.25;
  const NoiseSigma sigma = noiseSigma(recordings, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::sidecar);
  EXPECT_EQ(sigma.value, 0.25);
}

TEST(NoiseSigma, ThenFromQuietRows) {
  const NoiseSigma sigma = noiseSigma({noisyWave(3)}, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::quiet_rows);
  EXPECT_NEAR(sigma.value, std_mm, 0.1 * std_mm);
}

/// A lever that swings all the time at 2.5 Hz in rows 20 ms apart: second differences are motion.
TEST(NoiseSigma, IsThatOfTheReadingsWhereNothingIsQuiet) {
  Recording recording = noisyWave(5);
  for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
    recording.time_s[row] = 0.02 * static_cast<double>(row);
    recording.signals[1].values[row] += 100 * std::sin(2 * std::numbers::pi * 2.5 * recording.time_s[row]);
  }
  const NoiseSigma sigma = noiseSigma({recording}, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::quiet_rows);
  EXPECT_NEAR(sigma.value, std_mm, 0.2 * std_mm);
}

TEST(NoiseSigma, OfASignalThatIsReadInEveryOtherRowIsThatOfItsReadings) {
  std::vector<Recording> recordings = {noisyWave(3)};
  for (std::size_t row = 1; row < recordings[0].time_s.size(); row += 2)
    recordings[0].signals[1].values[row] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(noiseSigma(recordings, "length_0_mm").value, std_mm, 0.15 * std_mm);
}

/// A sensor that is read five times less often than it is logged.
TEST(NoiseSigma, OfReadingsThatAreHeldIsThatOfWhatWasRead) {
  constexpr int count = 8;
  for (const std::size_t every : {2, 3, 4, 5}) {
    double mean = 0;
    for (int seed = 1; seed <= count; ++seed) {
      Recording recording = noisyWave(static_cast<std::uint64_t>(seed));
      std::vector<double>& y = recording.signals[1].values;
      for (std::size_t row = 0; row < y.size(); ++row) y[row] = y[row - row % every];
      const NoiseSigma sigma = noiseSigma({recording}, "length_0_mm");
      EXPECT_EQ(sigma.source, NoiseSigma::Source::quiet_rows);
      mean += sigma.value / count;
    }
    EXPECT_NEAR(mean, std_mm, 0.15 * std_mm) << "read every " << every << " rows";
  }
}

TEST(NoiseSigma, OfLostSamplesIsThatOfTheOthers) {
  Recording recording = noisyWave(1);
  std::vector<double>& y = recording.signals[1].values;
  RandomStream random(1, "lost");
  for (std::size_t row = 1; row < y.size(); ++row)
    if (random.uniform() < 0.5) y[row] = y[row - 1];
  EXPECT_NEAR(noiseSigma({recording}, "length_0_mm").value, std_mm, 0.2 * std_mm);
}

TEST(NoiseSigma, IsAThousandthOfTheRangeWhereNothingElseTellsIt) {
  Recording few = noisyWave(3);
  few.time_s.resize(15);
  for (Signal& signal : few.signals) signal.values.resize(15);
  for (std::size_t row = 0; row < 15; ++row) few.signals[1].values[row] = 200 + std::sqrt(static_cast<double>(row));
  const NoiseSigma sigma = noiseSigma({few}, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::range);
  EXPECT_NEAR(sigma.value, 1e-3 * std::sqrt(14.0), 1e-9);
  EXPECT_TRUE(sigma.isEstimated());
}

TEST(NoiseSigma, IsAThousandthOfTheRangeForTheRecordingOfASimulation) {
  Recording smooth = noisyWave(1);
  for (std::size_t row = 0; row < smooth.time_s.size(); ++row)
    smooth.signals[1].values[row] = 200 + 20 * std::sin(0.01 * static_cast<double>(row)) + 1e-8 * static_cast<double>(row % 7);
  const NoiseSigma sigma = noiseSigma({smooth}, "length_0_mm");
  EXPECT_EQ(sigma.source, NoiseSigma::Source::range);
  EXPECT_NEAR(sigma.value, 0.04, 1e-3);
}

TEST(NoiseSigma, IsNeverBelowTheResolutionOfTheValues) {
  Recording recording = noisyWave(4);
  for (double& value : recording.signals[1].values) value = 0.5 * std::round(value / 0.5);
  recording.info.noise_std["length_0_mm"] = 1e-6;
  EXPECT_NEAR(noiseSigma({recording}, "length_0_mm").value, 0.5 / std::sqrt(12.0), 1e-9);
}

TEST(LatticeStep, IsTheStepOfRoundedValuesAndZeroForOthers) {
  EXPECT_DOUBLE_EQ(latticeStep({0.25, 1.5, 0.75, 1.0, 2.75, 3.0, 0.5, 2.0}), 0.25);
  EXPECT_EQ(latticeStep({0.2, 0.8, 0.2, 0.8, 1.4}), 0) << "a few values are no lattice";
  EXPECT_EQ(latticeStep({0, 1, std::sqrt(2.0), 3}), 0);
  EXPECT_EQ(latticeStep({1, 1, 1}), 0);
}

}  // namespace
}  // namespace musclesim
