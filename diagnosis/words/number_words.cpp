#include "number_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace musclesim {

bool isLeftOut(const Estimate& estimate) {
  return estimate.value == 0 && (!estimate.is_determined || (estimate.low == 0 && estimate.high == 0));
}

std::string roundedWords(double value, int decimals) {
  std::string words = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = words.find_first_of("123456789") == std::string::npos;
  return is_zero && words.front() == '-' ? words.substr(1) : words;
}

std::string estimateWords(const Estimate& estimate) {
  constexpr int most_decimals = 8;
  if (!estimate.is_determined) return fmt::format("{:.3g} (these recordings do not determine it)", estimate.value);
  const double half = (estimate.high - estimate.low) / 2;
  if (!(half > 0)) return fmt::format("{:.4g}", estimate.value);
  const int power = static_cast<int>(std::floor(std::log10(half)));
  const bool begins_with_one = half < 2 * std::pow(10, power);
  const int decimals = (begins_with_one ? 1 : 0) - power;
  auto words = [&](double value) {
    if (value == 0) return std::string("0");
    return decimals > most_decimals ? fmt::format("{:.4g}", value) : roundedWords(value, std::max(0, decimals));
  };
  return fmt::format("{} ({} to {})", words(estimate.value), words(estimate.low), words(estimate.high));
}

std::string counted(std::size_t count, const std::string& one, const std::string& several) {
  return count == 1 ? "1 " + one : fmt::format("{} {}", count, several.empty() ? one + "s" : several);
}

std::string percentWords(double percent) {
  return percent > nearly_all ? "more than 99.9 %" : fmt::format("{:.1f} %", percent);
}

std::string leftWords(double percent) {
  constexpr double least_told_percent = 0.1;
  return percent < least_told_percent ? "less than 0.1 %" : fmt::format("{:.3g} %", percent);
}

std::string probabilityWords(double probability) {
  constexpr double nearly_certain = 0.995;
  if (probability > nearly_certain) return "over 99 %";
  return probability < 1 - nearly_certain ? "under 1 %" : fmt::format("{:.0f} %", 100 * probability);
}

}  // namespace musclesim
