#include "diagnosis/prediction_store.h"

#include <gtest/gtest.h>

#include <atomic>

#include "base/parallel.h"

namespace musclesim {
namespace {

Prediction predictionOf(double value) {
  return {{{value, value}, {value}}};
}

TEST(PredictionStore, MakesAPredictionOnce) {
  PredictionStore store;
  int made = 0;
  const auto make = [&] {
    ++made;
    return predictionOf(made);
  };
  EXPECT_EQ(store.get("a", make).values, predictionOf(1).values);
  EXPECT_EQ(store.get("a", make).values, predictionOf(1).values);
  EXPECT_EQ(store.get("b", make).values, predictionOf(2).values);
  EXPECT_EQ(made, 2);
}

TEST(PredictionStore, ForgetsWhatIsTooMuchButKnowsThatItWasAskedFor) {
  PredictionStore store(7);  // two of three numbers each
  int made = 0;
  const auto make = [&] {
    ++made;
    return predictionOf(made);
  };
  for (const char* key : {"a", "b", "a", "b"}) store.get(key, make);
  EXPECT_EQ(made, 2);
  store.get("c", make);
  store.get("a", make);
  EXPECT_EQ(made, 4);
  EXPECT_TRUE(store.isNew("a"));
  EXPECT_FALSE(store.isNew("a"));
  store.get("d", make);
  EXPECT_FALSE(store.isNew("a"));
}

TEST(PredictionStore, GivesEveryThreadThePredictionItAskedFor) {
  PredictionStore store(100);
  std::atomic<int> wrong = 0, counted = 0;
  parallelFor(2000, 8, [&](int i) {
    const int which = i % 50;
    if (store.isNew(std::to_string(which))) ++counted;
    if (store.get(std::to_string(which), [&] { return predictionOf(which); }).values != predictionOf(which).values) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(counted, 50);
}

}  // namespace
}  // namespace musclesim
