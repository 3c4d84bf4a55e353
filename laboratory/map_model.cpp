#include "map_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace musclesim {

namespace {

/// Weights of the penalty, chosen by cross-validation on measured maps (docs/user/laboratory.md).
constexpr double over_length_weight = 0.003, over_pressure_weight = 0.03;

int lengthCount(double range_ratio) {
  constexpr double distance_ratio = 0.05;
  return std::clamp(static_cast<int>(std::lround(range_ratio / distance_ratio)) + 1, 4, 16);
}

}  // namespace

MapModel::MapModel(const Specimen& specimen)
    : specimen_(specimen), length_count_(lengthCount(1 - specimen.shortest_mm / specimen.rest_length_mm)) {
  constexpr double unbounded = 1e12;
  for (int i = 0; i < pressure_count_; ++i)
    for (int j = 0; j < length_count_; ++j) parameters_.push_back({fmt::format("map_force_{}_{}_N", i, j), -unbounded, unbounded});
}

std::vector<Eigen::VectorXd> MapModel::starts() const {
  // Force proportional to pressure and to length above the shortest. The map is linear in its nodes, so one start is enough.
  Eigen::VectorXd start(pressure_count_ * length_count_);
  for (int i = 0; i < pressure_count_; ++i)
    for (int j = 0; j < length_count_; ++j)
      start(i * length_count_ + j) = specimen_.force_scale_N * i * j / ((pressure_count_ - 1.0) * (length_count_ - 1.0));
  return {start};
}

ForceMapTable MapModel::tableOf(const Eigen::VectorXd& parameters) const {
  ForceMapTable table;
  table.shortest_ratio = specimen_.shortest_mm / specimen_.rest_length_mm;
  table.longest_ratio = 1;
  table.force_N.resize(pressure_count_, length_count_);
  for (int i = 0; i < pressure_count_; ++i) table.force_N.row(i) = parameters.segment(i * length_count_, length_count_).transpose();
  return table;
}

std::unique_ptr<ForceLaw> MapModel::build(const Eigen::VectorXd& parameters) const {
  return std::make_unique<ForceMap>(specimen_.rest_length_mm, tableOf(parameters));
}

std::vector<LawConstant> MapModel::constants() const {
  std::vector<LawConstant> result;
  for (const auto& parameter : parameters_) result.push_back({parameter.name.substr(0, parameter.name.size() - 2), "N"});
  return result;
}

Eigen::VectorXd MapModel::penaltiesN(const Eigen::VectorXd& parameters) const {
  const Eigen::MatrixXd force_N = tableOf(parameters).force_N;
  std::vector<double> result;
  for (int i = 0; i < pressure_count_; ++i)
    for (int j = 1; j + 1 < length_count_; ++j)
      result.push_back(over_length_weight * (force_N(i, j - 1) - 2 * force_N(i, j) + force_N(i, j + 1)));
  for (int i = 1; i + 1 < pressure_count_; ++i)
    for (int j = 0; j < length_count_; ++j)
      result.push_back(over_pressure_weight * (force_N(i - 1, j) - 2 * force_N(i, j) + force_N(i + 1, j)));
  return Eigen::Map<Eigen::VectorXd>(result.data(), static_cast<Eigen::Index>(result.size()));
}

std::vector<std::pair<std::string, std::string>> MapModel::configuration(const Eigen::VectorXd& parameters) const {
  const ForceMapTable table = tableOf(parameters);
  std::vector<std::pair<std::string, std::string>> result = {{"map_shortest_ratio", fmt::format("{}", table.shortest_ratio)},
                                                             {"map_longest_ratio", fmt::format("{}", table.longest_ratio)},
                                                             {"map_pressure_count", std::to_string(pressure_count_)},
                                                             {"map_length_count", std::to_string(length_count_)}};
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    result.emplace_back(parameters_[i].name, fmt::format("{}", parameters(static_cast<Eigen::Index>(i))));
  return result;
}

}  // namespace musclesim
