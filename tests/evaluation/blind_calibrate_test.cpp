/// The fit of the evidence's weights to open answers.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "evaluation/blind/calibrate.h"
#include "log/log_fixture.h"
#include "musclesim/base/error.h"

namespace musclesim::blind {
namespace {

/// Two explanations: a right one that leaves `misfit` more beyond every tolerance, and a wrong one with one more effect.
TriedCase caseWith(const std::string& name, double misfit, bool larger_is_right) {
  const auto count = static_cast<Eigen::Index>(weightNames().size());
  TriedCase one{name, Eigen::MatrixXd::Zero(2, count), Eigen::VectorXd::Zero(2), {!larger_is_right, larger_is_right}};
  one.features.row(0).head(3).setConstant(misfit);
  one.features(1, 4) = 1;  // a further effect
  return one;
}

TEST(BlindCalibrate, MovesTheWeightsTowardsTheTruth) {
  std::vector<TriedCase> cases;
  // A further effect that gains this much is wrong: it should cost more than the weights in force make it.
  for (int i = 0; i < 20; ++i) cases.push_back(caseWith("case" + std::to_string(i), 1.2, false));
  const Calibration result = calibrate(cases);
  EXPECT_GT(result.after[4], result.before[4]);
  EXPECT_LT(result.after[0], result.before[0]);
  EXPECT_GT(result.mean_ln_after, result.mean_ln_before);
  EXPECT_EQ(result.used.size(), 20U);
}

TEST(BlindCalibrate, KeepsWeightsThatNothingDetermines) {
  const Calibration result = calibrate({caseWith("one", 1, true), caseWith("two", 1, true)});
  for (const Eigen::Index untouched : {3, 5, 6, 7}) EXPECT_NEAR(result.after[untouched], result.before[untouched], 1e-9);
}

TEST(BlindCalibrate, LeavesOutCasesWithoutARightExplanation) {
  TriedCase hopeless = caseWith("hopeless", 1, true);
  hopeless.is_right = {false, false};
  const Calibration result = calibrate({hopeless, caseWith("useful", 1, true)});
  EXPECT_EQ(result.unused, std::vector<std::string>{"hopeless"});
  EXPECT_EQ(result.used, std::vector<std::string>{"useful"});
}

TEST(BlindCalibrate, ReadsKeysAndAnswers) {
  const TemporaryFolder folder;
  writeText(folder.file("keys.json"), R"({"case01": {"kind": "double", "effects": [{"id": "valve_lag"}, {"id": "payload"}],
    "acceptable": [["valve_lag@all"], ["payload@*"]]}})");
  const auto trial = [](const std::string& effects) {
    return R"({"effects": [)" + effects + R"(], "misfits": [1, 2, 3], "complexity": [4, 1, 0, 0.5, 0, 0], "numbers_cost": 0.25})";
  };
  writeText(folder.file("case01.json"),
            R"({"fitted": {"trials": [)" + trial(R"("valve_lag@all", "payload@hand")") + "," + trial(R"("valve_lag@all")") + "]}}");
  const std::vector<TriedCase> cases = triedCases(folder.file("keys.json"), folder.file(""));
  ASSERT_EQ(cases.size(), 1U);
  EXPECT_EQ(cases[0].is_right, (std::vector<bool>{true, false}));
  EXPECT_EQ(cases[0].features(0, 2), 3);
  EXPECT_EQ(cases[0].features(0, 6), 0.5);
  EXPECT_EQ(cases[0].numbers_cost[1], 0.25);
  writeText(folder.file("case01.json"), R"({"fitted": {"trials": [{"effects": []}]}})");
  EXPECT_THROW(triedCases(folder.file("keys.json"), folder.file("")), BadFile);
}

}  // namespace
}  // namespace musclesim::blind
