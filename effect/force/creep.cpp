#include "creep.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "musclesim/robot/actuator.h"

namespace musclesim {

namespace {

constexpr int element_count = 4;  ///< differ from a smooth spectrum over two decades by 0.3 % of the creep, over three by 0.7 %

using Values = Eigen::Vector<double, element_count>;
using Matrix = Eigen::Matrix<double, element_count, element_count>;

/// Time constants in a geometric series about tau_s.
Values timeConstantsS(double tau_s, double decades) {
  Values result;
  for (int i = 0; i < element_count; ++i) result(i) = tau_s * std::pow(10, decades * (static_cast<double>(i) / (element_count - 1) - 0.5));
  return result;
}

}  // namespace

EffectInfo Creep::info() {
  return {.id = "creep",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the bladder yields slowly under load",
          .equation =
              "F' = F(p, l - x), x = sum x_i, tau_i dx_i/dt = amount / n (l - x - l_0) - x_i    F tension, l length, l_0 rest length of "
              "the force law, x creep; n = 1, tau_1 = time_constant_s, or with a spread n = 4",
          .signature = "the length drifts while the measured pressure is constant",
          .source =
              "Kelvin-Voigt elements in series; amounts of 0.07 to 0.19 with time constants of 0.53 to 1.0 s measured, 1 to 300 s in "
              "long holds",
          .parameters = {{"amount", "", 0, 0, 10, 0.03, 0.25, "slow change of length over the immediate change"},
                         {"time_constant_s", "s", 1, 1e-3, 1e4, 0.3, 30, "tau, geometric mean of all tau_i", true},
                         {"spread_decades", "decades", 0, 0, 4, 0, 2, "from the shortest to the longest tau_i; 0: tau alone", true}},
          .make = [](const EffectValues& values) {
            return std::make_unique<Creep>(values["amount"], values["time_constant_s"], values["spread_decades"]);
          }};
}

/// With y_i = x_i sqrt(tau_i) and d_i = 1 / sqrt(tau_i) the elements are dy/dt = a d (l - l_0) - (D + a d d^T) y, a = amount / n,
/// D = diag(1 / tau_i). The matrix is symmetric: its eigenvectors q are the modes, with x = sum (d . q)(q . y).
Creep::Creep(double amount, double time_constant_s, double spread_decades) {
  if (spread_decades == 0) {
    modes_ = {{amount / (1 + amount), (1 + amount) / time_constant_s}};
    return;
  }
  const double each = amount / element_count;
  const Values d = timeConstantsS(time_constant_s, spread_decades).cwiseInverse().cwiseSqrt();
  const Matrix rates = Matrix(d.cwiseAbs2().asDiagonal()) + each * d * d.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(rates);
  for (int i = 0; i < element_count; ++i) {
    const double rate_per_s = solver.eigenvalues()(i), along = solver.eigenvectors().col(i).dot(d);
    modes_.push_back({each * along * along / rate_per_s, rate_per_s});
  }
}

double Creep::stretchMm(double length_mm) const {
  return length_mm - actuator().restLengthMm();
}

double Creep::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  MuscleInput inside = input;
  const double stretch_mm = stretchMm(input.length_mm);
  for (const Mode& mode : modes_) {
    inside.length_mm -= mode.creep_mm;
    inside.rate_mm_per_s -= (mode.share * stretch_mm - mode.creep_mm) * mode.rate_per_s;
  }
  return below(inside);
}

void Creep::advance(const MuscleInput& input) {
  const double stretch_mm = stretchMm(input.length_mm);
  for (Mode& mode : modes_) {
    const double end_mm = mode.share * stretch_mm;
    mode.creep_mm = end_mm + (mode.creep_mm - end_mm) * std::exp(-input.time.h_s * mode.rate_per_s);
  }
}

void Creep::settle(const MuscleInput& input) {
  for (Mode& mode : modes_) mode.creep_mm = mode.share * stretchMm(input.length_mm);
}

}  // namespace musclesim
