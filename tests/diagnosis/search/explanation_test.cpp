// Sets of hypotheses and their models.
#include "diagnosis/search/explanation.h"

#include <gtest/gtest.h>

#include "../planted.h"

namespace musclesim {
namespace {

TEST(Overlap, IsThatOfAllAndOfCommonParts) {
  EXPECT_TRUE(overlap("muscle_1", "muscle_1"));
  EXPECT_TRUE(overlap("all", "muscle_1"));
  EXPECT_TRUE(overlap("signal_length_0", "all"));
  EXPECT_TRUE(overlap("muscle_0+muscle_1", "muscle_1"));
  EXPECT_TRUE(overlap("muscle_0", "muscle_0+muscle_1"));
  EXPECT_FALSE(overlap("muscle_1", "muscle_10"));
  EXPECT_FALSE(overlap("muscle_0+muscle_1", "muscle_10"));
}

class CausesOnARig : public testing::Test {
 protected:
  enum Index : std::size_t { threshold, payload, leak, leak_of_all };
  CausesOnARig() {
    causes_.hypotheses = {{effectInfo("threshold_pressure"), "muscle_0", plant_},
                          {effectInfo("payload"), "hand", plant_},
                          {effectInfo("leak"), "muscle_0", plant_},
                          {effectInfo("leak"), "all", plant_}};
    explanation_.members = {threshold, payload};
    explanation_.z = Eigen::Vector3d(0.5, 0.1, 0.4);
    explanation_.numbers = Eigen::VectorXd::Zero(plant_.numberCount());
  }
  DiagnosisOptions options_;
  OnSimulation on_simulation_ = [this] { ++simulation_count_; };
  Plant plant_{planted::plant({}), options_};
  Comparison comparison_{plant_, {{0, 0, 100}}};
  Causes causes_{plant_, on_simulation_};
  Explanation explanation_;
  int simulation_count_ = 0;
};

TEST_F(CausesOnARig, HaveTheCoordinatesOfTheirMembersOneAfterTheOther) {
  ASSERT_EQ(causes_.hypotheses[threshold].coordinateCount(), 2);
  EXPECT_EQ(causes_.firstCoordinate(explanation_, 0), 0);
  EXPECT_EQ(causes_.firstCoordinate(explanation_, 1), 2);
  explanation_.numbers[0] = 0.5;
  const Model model = causes_.modelOf(explanation_);
  ASSERT_EQ(model.effects.size(), 2U);
  EXPECT_EQ(model.effects[0].parameters, causes_.hypotheses[threshold].at(Eigen::Vector2d(0.5, 0.1)).parameters);
  EXPECT_EQ(model.effects[1].parameters, causes_.hypotheses[payload].at(Eigen::VectorXd::Constant(1, 0.4)).parameters);
  ASSERT_EQ(model.parameters.size(), 1U);
  EXPECT_EQ(model.parameters.front(), std::make_pair(plant_.numbers()[0].parameter.name, plant_.numberAt(0, 0.5)));
  EXPECT_EQ(causes_.labelsOf({payload, threshold}), (std::set<std::string>{"payload@hand", "threshold_pressure@muscle_0"}));
}

TEST_F(CausesOnARig, ClashOnOverlappingPlacesOnly) {
  EXPECT_TRUE(causes_.clash(leak, leak_of_all));
  EXPECT_FALSE(causes_.clash(leak, threshold)) << "another effect";
  EXPECT_FALSE(causes_.clash(payload, leak_of_all));
}

TEST_F(CausesOnARig, TakeOverWhatTheyShareWithOthersInItsVariant) {
  const std::size_t other_leak = causes_.hypotheses.size();
  causes_.hypotheses.emplace_back(effectInfo("leak"), "muscle_0", plant_);
  const Eigen::Index of_leak = causes_.hypotheses[leak].coordinateCount();
  Explanation other;
  other.members = {payload, other_leak};
  other.z = Eigen::VectorXd::LinSpaced(1 + of_leak, 0.6, 0.9);
  other.numbers = Eigen::VectorXd::Constant(plant_.numberCount(), 0.2);
  Explanation one;
  one.members = {leak, threshold};
  one.z = Eigen::VectorXd::LinSpaced(of_leak + 2, 0.1, 0.3);
  one.numbers = Eigen::VectorXd::Zero(plant_.numberCount());
  const Explanation result = causes_.takingOver(one, other);
  EXPECT_EQ(result.members, (std::vector<std::size_t>{other_leak, threshold}));
  ASSERT_EQ(result.z.size(), one.z.size());
  EXPECT_EQ(result.z.head(of_leak), other.z.tail(of_leak));
  EXPECT_EQ(result.z.tail(2), one.z.tail(2)) << "not shared";
  EXPECT_EQ(result.numbers, other.numbers);
}

/// A member that is taken away and put back at the values that it had.
TEST_F(CausesOnARig, GetAMemberAtItsValues) {
  const Model model = causes_.modelOf(explanation_);
  const Explanation back = causes_.with(causes_.without(explanation_, 1), payload, model.effects[1].parameters);
  EXPECT_EQ(back.members, explanation_.members);
  EXPECT_TRUE(back.z.isApprox(explanation_.z, 1e-12));
  EXPECT_EQ(back.numbers, explanation_.numbers);
}

TEST_F(CausesOnARig, AreClampedEachByItsOwnBounds) {
  const Eigen::VectorXd far = Eigen::Vector3d(1e6, -1e6, 1e6), clamped = causes_.clamped(explanation_.members, far);
  EXPECT_EQ(clamped.head(2), causes_.hypotheses[threshold].clamped(far.head(2)));
  EXPECT_EQ(clamped.tail(1), causes_.hypotheses[payload].clamped(far.tail(1)));
  EXPECT_LT(clamped[0], 1e6);
}

/// Only the numbers of the model have a prior.
TEST_F(CausesOnARig, AreFittedWithTheNumbersOfTheModel) {
  explanation_.numbers[1] = -1;
  const FitProblem problem = causes_.problemOf(explanation_, comparison_, Fidelity::fine);
  ASSERT_EQ(problem.start.size(), 3 + plant_.numberCount());
  EXPECT_EQ(problem.start.head(3), explanation_.z);
  EXPECT_EQ(problem.start.tail(plant_.numberCount()), explanation_.numbers);
  EXPECT_TRUE(problem.precision.head(3).isZero(0));
  EXPECT_TRUE(problem.precision.tail(plant_.numberCount()).isOnes(0));
  EXPECT_EQ(problem.predicted(problem.start), comparison_.predicted(causes_.modelOf(explanation_)));
  EXPECT_EQ(simulation_count_, 1);
  Eigen::VectorXd far = problem.start;
  far[3] = 100;
  EXPECT_EQ(problem.clamped(far)[3], plant_.clampedNumbers(far.tail(plant_.numberCount()))[0]);
}

}  // namespace
}  // namespace musclesim
