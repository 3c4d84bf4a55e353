#include "diagnosis/model/prediction_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>

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
  PredictionStore store(nullptr, 7);  // two of three numbers each
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
  PredictionStore store(nullptr, 100);
  std::atomic<int> wrong = 0, counted = 0;
  parallelFor(2000, 8, [&](int i) {
    const int which = i % 50;
    if (store.isNew(std::to_string(which))) ++counted;
    if (store.get(std::to_string(which), [&] { return predictionOf(which); }).values != predictionOf(which).values) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(counted, 50);
}

TEST(PredictionStore, BytesKeepEveryBit) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const Prediction prediction{{{0.1, -0.0, missing, 1e-310, missing, missing}, {}, {missing}}, true, false};
  const std::optional<Prediction> again = predictionFrom(bytesOf(prediction));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->diverged);
  EXPECT_FALSE(again->refused);
  ASSERT_EQ(again->values.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(again->values[i].size(), prediction.values[i].size());
    for (std::size_t row = 0; row < prediction.values[i].size(); ++row)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(again->values[i][row]), std::bit_cast<std::uint64_t>(prediction.values[i][row]));
  }
}

TEST(PredictionStore, BytesOfSomethingElseAreNoPrediction) {
  const std::string bytes = bytesOf(predictionOf(1));
  EXPECT_FALSE(predictionFrom(""));
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(predictionFrom(bytes.substr(0, size))) << size;
  EXPECT_FALSE(predictionFrom(bytes + "x"));
  EXPECT_FALSE(predictionFrom(std::string(64, '\xff')));
}

TEST(PredictionStore, AnotherStoreGoesOnFromTheFileButNotFromWhatWasCut) {
  const std::string name = (std::filesystem::temp_directory_path() / ("musclesim_kept_" + std::to_string(getpid()))).string();
  int made = 0;
  const auto make = [&] { return predictionOf(++made); };
  {
    RecordFile file(name);
    file.begin("origin");
    PredictionStore store(&file);
    store.get("a", make);
    store.get("cut", [&] {
      Prediction cut = make();
      cut.cut = cut.diverged = true;
      return cut;
    });
  }
  RecordFile file(name);
  EXPECT_EQ(file.resume(), 1u);
  PredictionStore store(&file);
  EXPECT_EQ(store.get("a", make).values, predictionOf(1).values);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(store.get("cut", make).values, predictionOf(3).values);
  file.remove();
  EXPECT_FALSE(std::filesystem::exists(name));
}

}  // namespace
}  // namespace musclesim
