// Linear models of a residual: amounts of columns that are known.
#include "diagnosis/fit/linear_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "../planted.h"

namespace musclesim {
namespace {

/// Columns are waves of 20 sigmas on two segments, with averages.
class LinearModelOnARig : public testing::Test {
 protected:
  using Column = LinearModel::Column;

  LinearModelOnARig() {
    RandomStream random(1, "linear model");
    noise_ = along([&](double) { return random.normal(); });
  }

  /// A vector over all rows, with the averages of its rows.
  Eigen::VectorXd along(const std::function<double(double)>& of_row) const {
    Eigen::VectorXd result(comparison_.size());
    for (const Comparison::Block& block : comparison_.blocks())
      for (Eigen::Index i = 0; i < block.count(); ++i)
        result[block.first + i] = block.averaged_rows > 0 ? meanOfBlock(result, block.first_averaged, i)
                                                          : planted::noise_mm * of_row(static_cast<double>(block.first + i));
    return result;
  }
  Eigen::VectorXd slow() const {
    return along([](double row) { return 20 * std::sin(0.03 * row); });
  }
  Eigen::VectorXd fast() const {
    return along([](double row) { return 20 * std::cos(0.2 * row); });
  }
  /// Partly the same as slow().
  Eigen::VectorXd similar() const {
    return along([](double row) { return 20 * std::sin(0.03 * row + 0.7); });
  }
  static Column column(Eigen::VectorXd change, double least, double most, double precision = 0, double start = 0) {
    return {shared(std::move(change)), least, most, precision, start};
  }
  static Column free(Eigen::VectorXd change) { return column(std::move(change), -5, 5); }

  DiagnosisOptions options_;
  Plant plant_{planted::plant({}), options_};
  Comparison comparison_{plant_, {{0, 0, 160}, {1, 0, 160}}, Comparison::Derived::with};
  Eigen::VectorXd noise_;
};

TEST_F(LinearModelOnARig, FindsTheAmounts) {
  const Eigen::VectorXd residual = 2 * slow() - 0.7 * fast() + noise_;
  comparison_.setGap(residual);
  const LinearModel model(comparison_, residual, {free(slow()), free(similar()), free(fast())});
  const LinearModel::Solution all = model.solve({0, 1, 2}), two = model.solve({2, 0});
  EXPECT_NEAR(all.amounts[0], 2, 0.03);
  EXPECT_NEAR(all.amounts[1], 0, 0.03);
  EXPECT_NEAR(all.amounts[2], -0.7, 0.03);
  ASSERT_EQ(two.amounts.size(), 2);
  EXPECT_NEAR(two.amounts[0], -0.7, 0.03) << "in the order that they were asked for";
  EXPECT_NEAR(two.amounts[1], 2, 0.03);
  EXPECT_NEAR(two.cost, all.cost, 0.5) << "the third column only fits noise";
  EXPECT_GT(model.solve({1, 2}).cost, two.cost + comparison_.scale() / 2) << "another column is no substitute";
  EXPECT_NEAR(model.solve({}).cost, comparison_.misfit(residual), 1e-9);
}

TEST_F(LinearModelOnARig, CostIsTheMisfitOfWhatIsLeftPlusThePriors) {
  const Eigen::VectorXd residual = 2 * slow() - 0.7 * fast() + noise_;
  comparison_.setGap(residual);
  const LinearModel model(comparison_, residual, {column(slow(), -5, 5, 2, 0.5), column(fast(), -0.5, 5, 3), column(similar(), 1, 1)});
  for (const std::vector<std::size_t>& columns : {std::vector<std::size_t>{0}, {0, 1}, {0, 1, 2}, {2}}) {
    const LinearModel::Solution solution = model.solve(columns);
    Eigen::VectorXd left = residual;
    double prior = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double amount = solution.amounts[static_cast<Eigen::Index>(i)];
      left -= amount * (columns[i] == 0 ? slow() : columns[i] == 1 ? fast() : similar());
      prior += columns[i] == 0 ? 2 * std::pow(0.5 + amount, 2) / 2 : columns[i] == 1 ? 3 * amount * amount / 2 : 0;
    }
    EXPECT_NEAR(solution.cost, comparison_.misfit(left) + prior, 1e-6) << columns.size();
  }
}

/// The other amount is the best one beside the bound.
TEST_F(LinearModelOnARig, KeepsBounds) {
  const Eigen::VectorXd residual = 2 * slow() - 0.7 * similar() + noise_;
  comparison_.setGap(residual);
  const LinearModel bounded(comparison_, residual, {column(slow(), 0, 1.5), free(similar())});
  const LinearModel beside(comparison_, residual - 1.5 * slow(), {free(similar())});
  const LinearModel::Solution solution = bounded.solve({0, 1}), expected = beside.solve({0});
  EXPECT_EQ(solution.amounts[0], 1.5);
  EXPECT_NEAR(solution.amounts[1], expected.amounts[0], 0.01);
  EXPECT_NEAR(solution.cost, expected.cost, 0.01);
  const LinearModel positive(comparison_, residual, {column(similar(), 0, 5), column(-slow(), 0, 5)});
  EXPECT_EQ(positive.solve({1}).amounts[0], 0) << "only the other sign would help";
}

/// A member of an explanation that is dropped is a column whose amount is 1.
TEST_F(LinearModelOnARig, TakesFixedColumnsAsTheyAre) {
  const Eigen::VectorXd residual = fast() + 2 * slow() + noise_;
  comparison_.setGap(residual);
  const LinearModel model(comparison_, residual, {column(fast(), 1, 1), free(slow()), column(similar(), 1, 1)});
  const LinearModel::Solution helps = model.solve({0, 1}), harms = model.solve({2, 0});
  EXPECT_EQ(helps.amounts[0], 1);
  EXPECT_NEAR(helps.amounts[1], 2, 0.03);
  EXPECT_NEAR(helps.cost, comparison_.misfit(noise_), 0.5);
  EXPECT_NEAR(harms.cost, comparison_.misfit(residual - similar() - fast()), 1e-9);
}

/// The least cost by a fine grid of amounts. A few reweightings come within a tenth of a nat of it.
TEST_F(LinearModelOnARig, PriorsPullTheAmounts) {
  const Eigen::VectorXd residual = 0.5 * slow() + 3 * noise_;
  comparison_.setGap(residual);
  for (const double start : {0.0, 0.4}) {
    double last = 1;
    for (const double precision : {0.0, 10.0, 100.0, 1000.0}) {
      const auto costAt = [&](double amount) {
        return comparison_.misfit(residual - amount * slow()) + precision / 2 * std::pow(start + amount, 2);
      };
      double least = -1;
      for (double amount = -1; amount <= 1; amount += 0.0005)
        if (costAt(amount) < costAt(least)) least = amount;
      const LinearModel::Solution found = LinearModel(comparison_, residual, {column(slow(), -5, 5, precision, start)}).solve({0});
      EXPECT_LT(found.cost, costAt(least) + 0.1) << precision << " " << start;
      EXPECT_LT(found.amounts[0], last) << "the prior is felt";
      last = found.amounts[0];
      if (precision == 0) {
        EXPECT_NEAR(found.amounts[0], 0.5, 0.03);
      }
    }
    EXPECT_LT(last, 0.1 - start / 2) << "near the prior";
  }
}

}  // namespace
}  // namespace musclesim
