#include "../controller/waves.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <set>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Waves, TriangleAndSquareByTheirCorners) {
  for (const double cycle : {-3.0, 0.0, 7.0}) {
    EXPECT_EQ(triangleWave(cycle), -1);
    EXPECT_EQ(triangleWave(cycle + 0.25), 0);
    EXPECT_EQ(triangleWave(cycle + 0.5), 1);
    EXPECT_EQ(triangleWave(cycle + 0.75), 0);
    EXPECT_EQ(squareWave(cycle), 1);
    EXPECT_EQ(squareWave(cycle + 0.4999), 1);
    EXPECT_EQ(squareWave(cycle + 0.5), -1);
  }
}

TEST(Waves, ChirpsPassTheirFrequencies) {
  const auto frequencyAt = [](const Chirp& chirp, double t) { return (chirp.cycles(t + 1e-5) - chirp.cycles(t - 1e-5)) / 2e-5; };
  const Chirp linear{0.5, 4.5, 20, false}, octaves{0.25, 4, 20, true};
  for (const double t : {1.0, 5.0, 19.0}) {
    EXPECT_NEAR(frequencyAt(linear, t), 0.5 + 4.0 * t / 20, 1e-6);
    EXPECT_NEAR(frequencyAt(octaves, t), 0.25 * std::pow(16, t / 20), 1e-6);
  }
  EXPECT_NEAR(frequencyAt(octaves, 5), 0.5, 1e-6) << "one octave in a quarter of the time of four";
  EXPECT_NEAR(frequencyAt(linear, 30), 4.5, 1e-6) << "stays at the last frequency";
  EXPECT_DOUBLE_EQ(linear.cycles(20), 50) << "the mean frequency times the time";
  EXPECT_DOUBLE_EQ(linear.at(20.25), std::sin(2 * pi * (50 + 0.25 * 4.5)));
  EXPECT_DOUBLE_EQ((Chirp{2, 2, 5, true}.cycles(3)), 6) << "no ratio to divide by";
}

TEST(Waves, StairsGoUpAndDown) {
  const double levels[] = {-1, -0.5, 0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5};
  for (int k = 0; k < 10; ++k) EXPECT_EQ(stairsWave(2.0 * k + 0.3, 2, 4), levels[k]) << k;
}

TEST(Waves, ReversalsShrinkAtAConstantRate) {
  const double period_s = 6;
  EXPECT_DOUBLE_EQ(reversalsWave(1.5, period_s, 3), 1);
  EXPECT_DOUBLE_EQ(reversalsWave(4.5, period_s, 3), -1);
  EXPECT_NEAR(reversalsWave(6 + 1, period_s, 3), 2.0 / 3, 1e-12);
  EXPECT_NEAR(reversalsWave(6 + 4 + 0.5, period_s, 3), 1.0 / 3, 1e-12);
  EXPECT_NEAR(reversalsWave(12 + 1.5, period_s, 3), 1, 1e-12) << "begins again after 6 + 4 + 2 s";
  for (double t = 0; t < 24; t += 0.013)
    EXPECT_LE(std::abs(reversalsWave(t + 1e-6, period_s, 3) - reversalsWave(t, period_s, 3)), 4 / period_s * 1e-6 + 1e-12) << t;
}

TEST(Waves, BinarySequencesHaveMaximalLength) {
  for (int order = BinarySequence::smallest_order; order <= BinarySequence::largest_order; ++order) {
    const BinarySequence sequence(order);
    ASSERT_EQ(sequence.length(), (1L << order) - 1);
    std::set<long> contents;
    double sum = 0;
    for (long k = 0; k < sequence.length(); ++k) {
      long content = 0;
      for (int bit = 0; bit < order; ++bit) content = 2 * content + (sequence.at(k + bit) > 0);
      contents.insert(content);
      sum += sequence.at(k);
      EXPECT_EQ(sequence.at(k + sequence.length()), sequence.at(k));
    }
    EXPECT_EQ(contents.size(), static_cast<std::size_t>(sequence.length()))
        << "order " << order << ": a content of the register is missing";
    EXPECT_EQ(sum, 1) << order;
  }
  const BinarySequence sequence(6);
  for (const long shift : {1L, 5L, 31L}) {
    double correlation = 0;
    for (long k = 0; k < sequence.length(); ++k) correlation += sequence.at(k) * sequence.at(k + shift);
    EXPECT_EQ(correlation, -1) << shift;
  }
  EXPECT_EQ(BinarySequence(6, 10).at(3), sequence.at(13));
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { BinarySequence(13); }), "13"));
}

TEST(Waves, ThePeakOfAMultisineIsThatOfAllItsPoints) {
  for (const auto& [first, last] : {std::pair{1, 1}, {3, 8}, {1, 40}, {97, 101}, {211, 211}, {5, 127}}) {
    std::vector<int> harmonics;
    for (int m = first; m <= last; ++m) harmonics.push_back(m);
    const std::vector<double> phases = Multisine::schroederPhases(harmonics.size());
    double largest = 0, start = 0;
    for (int i = 0; i < 64 * last; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < harmonics.size(); ++k) sum += std::cos(2 * pi * harmonics[k] * i / (64.0 * last) + phases[k]);
      largest = std::max(largest, std::abs(sum));
      if (i == 0) start = sum;
    }
    EXPECT_NEAR(Multisine(harmonics, phases, 10).at(0), start / largest, 1e-9) << first << " .. " << last;
  }
}

TEST(Waves, ThePeakOfAThousandFrequenciesIsFoundFast) {
  using Clock = std::chrono::steady_clock;
  std::vector<int> harmonics;
  for (int m = 1; m <= 1009; ++m) harmonics.push_back(m);
  const auto begin = Clock::now();
  const Multisine wave(harmonics, Multisine::schroederPhases(harmonics.size()), 100);
  const auto made = Clock::now();
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += wave.at(0.1 * i);
  const auto evaluated = Clock::now();
  EXPECT_LT(std::abs(sum), 1000);
  EXPECT_LT((made - begin) / 8, evaluated - made) << "its 64576 points one by one would take as long as 64576 evaluations";
}

TEST(Waves, MultisineHasItsBandAndNoMore) {
  const auto harmonics = Multisine::harmonics(0.3, 0.8, 10);
  EXPECT_EQ(harmonics, (std::vector<int>{3, 4, 5, 6, 7, 8}));
  const Multisine wave(harmonics, Multisine::schroederPhases(harmonics.size()), 10);
  const int count = 1000;
  double largest = 0, squares = 0;
  std::vector<double> power(20);
  for (int m = 0; m < 20; ++m) {
    double re = 0, im = 0;
    for (int i = 0; i < count; ++i) {
      re += wave.at(10.0 * i / count) * std::cos(2 * pi * m * i / count);
      im += wave.at(10.0 * i / count) * std::sin(2 * pi * m * i / count);
    }
    power[static_cast<std::size_t>(m)] = (re * re + im * im) / (count * count);
  }
  for (int m = 0; m < 20; ++m) EXPECT_NEAR(power[static_cast<std::size_t>(m)], m >= 3 && m <= 8 ? power[3] : 0, 1e-12) << m;
  for (int i = 0; i < 20000; ++i) {
    const double s = wave.at(10.0 * i / 20000);
    largest = std::max(largest, std::abs(s));
    squares += s * s / 20000;
  }
  EXPECT_LE(largest, 1);
  EXPECT_GE(largest, 0.998);
  EXPECT_LT(largest / std::sqrt(squares), 2.1) << "Schroeder's phases keep the crest factor low; equal phases would give 3.5";
  EXPECT_NEAR(wave.at(13.37), wave.at(3.37), 1e-12);
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { Multisine::harmonics(0.31, 0.39, 10); }), "0.31 .. 0.39"));
}

}  // namespace
}  // namespace musclesim
