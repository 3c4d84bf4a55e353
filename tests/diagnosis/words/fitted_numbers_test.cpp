// Numbers of the model that were fitted.
#include "diagnosis/words/fitted_numbers.h"

#include <gtest/gtest.h>

#include "support/support.h"

namespace musclesim {
namespace {

Diagnosis withLoad(Verdict verdict) {
  Diagnosis d;
  d.verdict = verdict;
  d.numbers = {{"rig.load_kg", "kg", 2, {2.2, 2.1, 2.3, true}, 2.4}};
  d.reduction_percent = 97;
  return d;
}

TEST(FittedNumbers, MayExplainAGap) {
  Diagnosis d = withLoad(Verdict::no_gap);
  EXPECT_TRUE(isExplainedByNumbers(d));
  d.reduction_percent = 0;
  EXPECT_FALSE(isExplainedByNumbers(d)) << "there was none";
  EXPECT_FALSE(isExplainedByNumbers(withLoad(Verdict::unexplained)));
}

TEST(FittedNumbers, AreToldWhereTheyAreFarOff) {
  Diagnosis d = withLoad(Verdict::no_gap);
  EXPECT_EQ(numbersWords(d), "The data speak for rig.load_kg = 2.20 (2.10 to 2.30) instead of 2 kg.");
  d.chosen = {"valve_lag@all"};
  EXPECT_TRUE(contains(numbersWords(d), "use effects.json with nominal.toml"));
  d.numbers.front().in_tolerances = 0.9;
  EXPECT_EQ(numbersWords(d), "");
  d.numbers.front() = {"rig.load_kg", "kg", 2, {2.2, 1.9, 2.5, true}, 2.4};
  EXPECT_EQ(numbersWords(d), "") << "the given value is possible";
}

TEST(FittedNumbers, SayWhatTheyRemove) {
  Diagnosis d = withLoad(Verdict::unexplained);
  EXPECT_TRUE(contains(fittedNumbersSentence(d), "remove 97.0 % of the gap"));
  d.attempt.effects = {"leak@muscle_0"};
  EXPECT_EQ(fittedNumbersSentence(d), "") << "they were fitted beside it";
  EXPECT_EQ(retunedSentence(d), "");
  d.nominal_refit_percent = 40;
  EXPECT_TRUE(contains(retunedSentence(d), "removes 40.0 %"));
}

TEST(FittedNumbers, TheirFileSaysWithWhichEffects) {
  Diagnosis d = withLoad(Verdict::no_gap);
  EXPECT_TRUE(contains(fittedNumbersToml(d), "without any effect")) << fittedNumbersToml(d);
  EXPECT_TRUE(contains(fittedNumbersToml(d), "rig.load_kg = 2.2  # kg; 2.1 .. 2.3, from 2"));
  d.attempt.effects = {"leak@muscle_0"};
  EXPECT_TRUE(contains(fittedNumbersToml(d), "attempt.json"));
  d.chosen = {"leak@muscle_0"};
  EXPECT_TRUE(contains(fittedNumbersToml(d), "effects.json"));
}

}  // namespace
}  // namespace musclesim
