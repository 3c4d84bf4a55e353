// Points and slopes of a fit, on a prediction without a simulation.
#include "diagnosis/fit/fit_problem.h"

#include <gtest/gtest.h>

#include "../short_rig.h"

namespace musclesim {
namespace {

class FitProblemOnARig : public planted::ShortRig {
 protected:
  static constexpr double largest = 1, diverges_above = 0.9;

  /// z is at most 1; the prediction rises by 3 mm per z, and the model diverges above 0.9 where that is asked for.
  FitProblem problem(bool may_diverge) const {
    FitProblem problem;
    problem.start = Eigen::VectorXd::Zero(1);
    problem.precision = Eigen::VectorXd::Constant(1, 4);
    problem.clamped = [](const Eigen::VectorXd& z) -> Eigen::VectorXd { return z.cwiseMin(largest); };
    problem.predicted = [this, may_diverge](const Eigen::VectorXd& z) -> Eigen::VectorXd {
      if (may_diverge && z[0] > diverges_above) return {};
      return both.measured().array() + 3 * z[0];
    };
    return problem;
  }
  FitPoint at(double z, bool may_diverge) const { return evaluate(both, problem(may_diverge), Eigen::VectorXd::Constant(1, z)); }
};

TEST_F(FitProblemOnARig, APointIsWithinTheBoundsAndPaysItsPrior) {
  const FitPoint point = at(2, false);
  EXPECT_EQ(point.z[0], largest);
  EXPECT_DOUBLE_EQ(point.cost, both.misfit(point.residual) + 2) << "4 z^2 / 2";
  EXPECT_EQ(at(largest, true).residual.size(), 0) << "diverged";
}

TEST_F(FitProblemOnARig, SecantsTurnAwayFromBoundsAndFromWhereTheModelDiverges) {
  EXPECT_NEAR(secant(both, problem(false), at(0.5, false), 0, wide_difference).mean(), 3, 1e-9);
  EXPECT_NEAR(secant(both, problem(false), at(largest, false), 0, wide_difference).mean(), 3, 1e-9) << "at a bound";
  EXPECT_NEAR(secant(both, problem(true), at(0.8, true), 0, wide_difference).mean(), 3, 1e-9) << "it diverges on one side";
  EXPECT_LT(stepOf(problem(false), Eigen::VectorXd::Constant(1, largest), 0), 0);
  FitProblem held = problem(false);
  held.clamped = [](const Eigen::VectorXd&) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, 0.5); };
  EXPECT_EQ(secant(both, held, at(0.5, false), 0, wide_difference).size(), 0) << "between two bounds";
  EXPECT_EQ(stepOf(held, Eigen::VectorXd::Constant(1, 0.5), 0), 0);
}

}  // namespace
}  // namespace musclesim
