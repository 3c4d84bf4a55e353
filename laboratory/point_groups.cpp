#include "point_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace musclesim {

namespace {

constexpr double same_share = 0.002;
constexpr std::size_t most_groups = 40;
constexpr int bin_count = 10;

std::vector<PointGroup> merged(const std::vector<double>& values, const std::vector<std::size_t>& order, double distance) {
  std::vector<PointGroup> groups;
  double first = 0;
  for (const std::size_t i : order) {
    if (groups.empty() || values[i] - first > distance) {
      groups.emplace_back();
      first = values[i];
    }
    groups.back().of.push_back(i);
  }
  return groups;
}

std::vector<PointGroup> binned(const std::vector<double>& values, const std::vector<std::size_t>& order) {
  const double low = values[order.front()], width = (values[order.back()] - low) / bin_count;
  std::vector<PointGroup> bins(bin_count);
  for (const std::size_t i : order)
    bins[static_cast<std::size_t>(std::clamp(static_cast<int>((values[i] - low) / width), 0, bin_count - 1))].of.push_back(i);
  std::erase_if(bins, [](const auto& bin) { return bin.of.empty(); });
  return bins;
}

std::vector<PointGroup> grouped(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  if (order.empty()) return {};
  auto groups = merged(values, order, same_share * std::abs(values[order.back()]));
  if (groups.size() > most_groups) groups = binned(values, order);
  for (auto& group : groups) {
    for (const std::size_t i : group.of) group.value += values[i];
    group.value /= static_cast<double>(group.of.size());
  }
  return groups;
}

}  // namespace

std::vector<PointGroup> groupByPressure(const std::vector<StaticPoint>& points) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(point.pressure_ratio);
  return grouped(values);
}

std::vector<PointGroup> groupByLength(const std::vector<StaticPoint>& points) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(point.length_mm);
  return grouped(values);
}

}  // namespace musclesim
