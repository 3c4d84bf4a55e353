#include "measured_values.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "parity.h"

namespace musclesim {

namespace {

const std::array<std::string, 3> hand_signals = {"hand_x_mm", "hand_y_mm", "hand_z_mm"};

bool isFinite(double value) {
  return std::isfinite(value);
}

/// Signals of motion that each recording has.
std::vector<int> signalsOfMotion(const Plant& plant) {
  std::vector<int> result;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    bool is_in_all = isMotion(plant.signals()[s].name);
    for (std::size_t r = 0; r < plant.recordings().size(); ++r)
      is_in_all = is_in_all && !plant.measured(static_cast<int>(r), static_cast<int>(s)).empty();
    if (is_in_all) result.push_back(static_cast<int>(s));
  }
  return result;
}

/// One column per signal, and one for the constant of a linear function; rows without a value of each signal are not finite.
template <typename ValuesOf>
Eigen::MatrixXd columnsOf(const std::vector<int>& signals, ValuesOf&& valuesOf) {
  const auto rows = static_cast<Eigen::Index>(valuesOf(signals.front()).size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(rows, static_cast<Eigen::Index>(signals.size()) + 1);
  for (std::size_t i = 0; i < signals.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::VectorXd>(valuesOf(signals[i]).data(), rows);
  return columns;
}

}  // namespace

std::vector<double> measuredValues(const Plant& plant, const std::string& signal) {
  std::vector<double> values;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    if (plant.signals()[s].name != signal) continue;
    for (std::size_t r = 0; r < plant.recordings().size(); ++r)
      std::ranges::copy_if(plant.measured(static_cast<int>(r), static_cast<int>(s)), std::back_inserter(values), isFinite);
  }
  return values;
}

std::array<std::vector<double>, 3> handMm(const Plant& plant) {
  constexpr double hardly_mm = 1;
  std::array<std::vector<double>, 3> hand;
  for (std::size_t axis = 0; axis < hand.size(); ++axis) hand[axis] = measuredValues(plant, hand_signals[axis]);
  const bool is_measured = std::ranges::any_of(hand, [](const std::vector<double>& values) { return !values.empty(); });
  const std::vector<int> signals = signalsOfMotion(plant);
  const Eigen::MatrixX3d of_model = is_measured || signals.empty() ? Eigen::MatrixX3d() : plant.nominalHandMm(0);
  if (of_model.rows() > 0) {
    const Prediction nominal = plant.predict(0, Model{});
    const Eigen::MatrixXd motion = columnsOf(
        signals, [&](int signal) -> const auto& { return nominal.values[static_cast<std::size_t>(signal)]; });
    const Eigen::MatrixX3d slopes = motion.colPivHouseholderQr().solve(of_model);
    const Eigen::Array3d extent_mm = (of_model.colwise().maxCoeff() - of_model.colwise().minCoeff()).transpose().array();
    const Eigen::Array<bool, 3, 1> moves = extent_mm > hardly_mm;
    for (int r = 0; r < static_cast<int>(plant.recordings().size()); ++r) {
      const Eigen::MatrixX3d places = columnsOf(
                                          signals, [&](int signal) -> const auto& { return plant.measured(r, signal); }) *
                                      slopes;
      for (std::size_t axis = 0; axis < hand.size(); ++axis)
        if (moves[static_cast<Eigen::Index>(axis)])
          std::ranges::copy_if(places.col(static_cast<Eigen::Index>(axis)), std::back_inserter(hand[axis]), isFinite);
    }
  }
  return hand;
}

}  // namespace musclesim
