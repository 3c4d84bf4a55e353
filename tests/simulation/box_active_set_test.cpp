#include "../../simulation/chain/box_active_set.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/base/random.h"

namespace musclesim::chain {
namespace {

/// A dense problem: w = A l - b.
class DenseProblem final : public BoxProblem {
 public:
  DenseProblem(Eigen::MatrixXd a, Eigen::VectorXd b) : a_(std::move(a)), b_(std::move(b)) {}

  void solve(std::vector<BoundedRow>& rows) override {
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd a = a_;
    Eigen::VectorXd b = b_;
    for (Eigen::Index i = 0; i < n; ++i) {
      const BoundedRow& row = rows[static_cast<std::size_t>(i)];
      if (row.state == RowState::free) continue;
      a.row(i).setZero();
      a(i, i) = 1;
      b(i) = row.bound();
    }
    const Eigen::VectorXd l = a.partialPivLu().solve(b);
    const Eigen::VectorXd w = a_ * l - b_;
    for (Eigen::Index i = 0; i < n; ++i) {
      BoundedRow& row = rows[static_cast<std::size_t>(i)];
      if (row.state == RowState::free)
        row.force = l(i);
      else
        row.slack = w(i);
    }
  }
  void changed(int) override {}
  double forceTolerance() const override { return 1e-10; }
  double slackTolerance() const override { return 1e-10; }

 private:
  Eigen::MatrixXd a_;
  Eigen::VectorXd b_;
};

/// Tries all 3^n sets of states.
std::vector<double> bruteForce(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, std::vector<BoundedRow> rows) {
  DenseProblem problem(a, b);
  long sets = 1;
  for (std::size_t i = 0; i < rows.size(); ++i) sets *= 3;
  for (long set = 0; set < sets; ++set) {
    long digits = set;
    bool possible = true;
    for (BoundedRow& row : rows) {
      row.state = static_cast<RowState>(digits % 3);
      digits /= 3;
      possible = possible && (row.state == RowState::free || std::isfinite(row.bound()));
      if (row.state != RowState::free) row.force = row.bound();
    }
    if (!possible) continue;
    problem.solve(rows);
    const bool fits = std::all_of(rows.begin(), rows.end(), [](const BoundedRow& row) {
      if (row.state == RowState::free) return row.force >= row.lower - 1e-9 && row.force <= row.upper + 1e-9;
      return row.state == RowState::at_lower ? row.slack >= -1e-9 : row.slack <= 1e-9;
    });
    if (!fits) continue;
    std::vector<double> forces;
    for (const BoundedRow& row : rows) forces.push_back(row.force);
    return forces;
  }
  return {};
}

struct RandomProblem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  std::vector<BoundedRow> rows;
};

/// `narrowness` 1: boxes as wide as the solution; small: narrow boxes, most rows at a bound.
RandomProblem makeProblem(RandomStream& random, int n, double narrowness) {
  RandomProblem p;
  Eigen::MatrixXd root(n, n);
  p.b.resize(n);
  p.rows.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    p.b(i) = random.normal();
    for (int j = 0; j < n; ++j) root(i, j) = random.normal();
  }
  p.a = root * root.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) {
    BoundedRow& row = p.rows[static_cast<std::size_t>(i)];
    const double width = narrowness * random.uniform(0.1, 1);
    const int kind = static_cast<int>(random.uniform(0, 3));
    row.lower = kind == 0 ? 0 : -width;
    row.upper = kind == 0 ? std::numeric_limits<double>::infinity() : width;
    row.diagonal = p.a(i, i);
    row.group = i / 3;
    row.state = static_cast<RowState>(kind == 0 ? 0 : static_cast<int>(random.uniform(0, 3)));
  }
  return p;
}

void expectSolved(BoxActiveSet& active_set, RandomProblem p) {
  const std::vector<double> expected = bruteForce(p.a, p.b, p.rows);
  DenseProblem problem(p.a, p.b);
  ASSERT_FALSE(expected.empty());
  ASSERT_TRUE(active_set.run(problem, p.rows).solved);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(p.rows[i].force, expected[i], 1e-6 * (1 + std::abs(expected[i])));
}

TEST(BoxActiveSet, FindsTheOnlySolutionOfRandomBoxes) {
  RandomStream random(7, "boxes");
  BoxActiveSet active_set;
  for (const double narrowness : {1.0, 0.1, 1e-4})
    for (int i = 0; i < 60; ++i) expectSolved(active_set, makeProblem(random, 2 + i % 5, narrowness));
}

TEST(BoxActiveSet, MonotonePhaseAloneFindsItToo) {
  RandomStream random(8, "boxes");
  BoxActiveSet active_set;
  active_set.most_rounds = 0;
  for (const double narrowness : {1.0, 0.1, 1e-4})
    for (int i = 0; i < 60; ++i) expectSolved(active_set, makeProblem(random, 2 + i % 5, narrowness));
}

TEST(BoxActiveSet, EndsOnLargerProblemsFromAnyStart) {
  RandomStream random(9, "boxes");
  BoxActiveSet active_set;
  for (int i = 0; i < 100; ++i) {
    RandomProblem p = makeProblem(random, 40, i % 2 == 0 ? 0.3 : 0.01);
    DenseProblem problem(p.a, p.b);
    const ActiveSetResult result = active_set.run(problem, p.rows);
    ASSERT_TRUE(result.solved);
    for (const BoundedRow& row : p.rows) {
      if (row.state == RowState::free) {
        EXPECT_GE(row.force, row.lower - 1e-9);
        EXPECT_LE(row.force, row.upper + 1e-9);
      } else {
        EXPECT_GE(row.state == RowState::at_lower ? row.slack : -row.slack, -1e-9);
      }
    }
  }
}

TEST(BoxActiveSet, RightStatesNeedOneRound) {
  RandomStream random(10, "boxes");
  BoxActiveSet active_set;
  RandomProblem p = makeProblem(random, 12, 0.2);
  DenseProblem problem(p.a, p.b);
  ASSERT_TRUE(active_set.run(problem, p.rows).solved);
  EXPECT_EQ(active_set.run(problem, p.rows).rounds, 1);
}

TEST(BoxActiveSet, SaysWhenItDoesNotEnd) {
  RandomStream random(11, "boxes");
  BoxActiveSet active_set;
  active_set.most_rounds = 0;
  active_set.most_monotone_rounds = 1;
  RandomProblem p = makeProblem(random, 20, 0.05);
  for (BoundedRow& row : p.rows) row.state = RowState::free;
  DenseProblem problem(p.a, p.b);
  EXPECT_FALSE(active_set.run(problem, p.rows).solved);
}

}  // namespace
}  // namespace musclesim::chain
