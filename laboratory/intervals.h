/// Confidence of the constants of a least-squares fit.
#pragma once

#include <Eigen/Core>

namespace musclesim {

/// How the scatter of the residuals propagates to the fitted parameters. Residuals may have different variances: the variance of residual i
/// is estimated as r_i^2 / (1 - h_i), h_i its leverage. Source: MacKinnon and White 1985 (there HC2).
struct Scatter {
  Eigen::MatrixXd influence;     ///< d parameters / d residuals, (J^T J)^-1 J^T
  Eigen::VectorXd variances;     ///< of the residuals
  Eigen::MatrixXd undetermined;  ///< columns: directions of the parameters (scaled by the columns of J) that leave the residuals unchanged;
                                 ///< none for a good fit
};

Scatter scatterOf(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals);

/// Degrees of freedom of the variance sum_i w_i^2 v_i, where the v_i are squares of single normal residuals. They are few if few residuals
/// dominate the sum. Satterthwaite's quotient (sum q)^2 / sum q^2, q_i = w_i^2 v_i, freed of the bias that single squares give it:
/// 3 (sum q)^2 / sum q^2 - 2. Source: Satterthwaite 1946; Lipsitz, Ibrahim and Parzen 1999 for sums like this.
double degreesOfFreedom(const Eigen::VectorXd& weights, const Eigen::VectorXd& variances);

/// The 97.5 % quantile of Student's t with these degrees of freedom. Source: Abramowitz and Stegun 26.7.5; error below
/// 0.3 % from 4 degrees on, which are the fewest it is used with.
double student975(double degrees_of_freedom);

}  // namespace musclesim
