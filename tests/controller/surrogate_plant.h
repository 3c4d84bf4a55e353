/// A cheap stand-in for the arm: the hand follows a smooth random function of ten pressures with a first-order lag.
#pragma once

#include <Eigen/Core>

#include "musclesim/base/random.h"
#include "musclesim/controller/controller.h"

namespace musclesim::test {

/// Hand at rest: mean + spread * (two-layer random function of the pressures, standardised); spread (60, 70, 60) mm about
/// (-250, -110, 60) mm, so that height 0 lies 1.6 standard deviations up and the point (-300, 0, 150) mm is rarer still. Lag 0.5 s.
class SurrogatePlant {
 public:
  static constexpr int muscle_count = 10;

  explicit SurrogatePlant(std::uint64_t seed)
      : stream_(seed, "plant"), inner_(normals(12, muscle_count) * 0.8), outer_(normals(3, 12)), offset_(normals(12, 1) * 0.5) {
    constexpr int samples = 2000;
    Vector sum = Vector::Zero(), squares = Vector::Zero();
    for (int i = 0; i < samples; ++i) {
      Action action(muscle_count);
      for (auto& p : action) p = stream_.uniform();
      const Vector y = response(action);
      sum += y;
      squares += y.cwiseAbs2();
    }
    mean_ = sum / samples;
    deviation_ = (squares / samples - mean_.cwiseAbs2()).cwiseSqrt();
  }

  State state() const {
    State state;
    state.time_s = time_s_;
    state.hand_mm = hand_mm_;
    return state;
  }
  void step(const Action& action, double step_s) {
    const Vector unit = (response(action) - mean_).cwiseQuotient(deviation_);
    const Vector rest = Vector(-250, -110, 60) + Vector(60, 70, 60).cwiseProduct(unit);
    hand_mm_ += (rest - hand_mm_) * (step_s / 0.5);
    time_s_ += step_s;
  }

 private:
  Eigen::MatrixXd normals(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return stream_.normal(); });
  }
  Vector response(const Action& action) const {
    const Eigen::Map<const Eigen::VectorXd> pressure(action.data(), muscle_count);
    const Eigen::VectorXd centred = (2.0 * pressure.array() - 1.0).matrix();
    return outer_ * (inner_ * centred + offset_).array().tanh().matrix();
  }

  RandomStream stream_;
  Eigen::MatrixXd inner_, outer_;
  Eigen::VectorXd offset_;
  Vector mean_, deviation_;
  Vector hand_mm_{-205.83, -241.17, 0};
  double time_s_ = 0;
};

}  // namespace musclesim::test
