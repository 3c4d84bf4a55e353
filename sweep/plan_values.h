/// The entries of a plan's sections: lists of values, and distributions to draw from.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <utility>
#include <vector>

#include "musclesim/base/random.h"
#include "sweep/sweep.h"

namespace musclesim {

/// The distribution that a parameter's values are drawn from.
struct Distribution {
  std::string name;
  double low = 0, high = 1;
  bool log = false;                       ///< uniform in the logarithm
  bool integer = false;                   ///< whole numbers low .. high
  std::vector<Parameter::Value> choices;  ///< instead of a range

  /// The quantile of the distribution at 0 <= unit < 1.
  Parameter::Value at(double unit) const;
};

/// Reads the sections of a plan; throws BadFile with the place of an error.
class PlanReader {
 public:
  explicit PlanReader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void refuse(const toml::node& node, const std::string& what) const;
  std::string text(const toml::node& node, const std::string& name) const;
  double number(const toml::node& node, const std::string& name) const;
  std::size_t count(const toml::node& node, const std::string& name) const;
  std::vector<std::string> texts(const toml::node& node, const std::string& name) const;
  Parameter::Value value(const toml::node& node, const std::string& name) const;

  using Values = std::vector<Parameter::Value>;
  /// Parameters with their lists of values; names of nested tables are joined by dots.
  std::vector<std::pair<std::string, Values>> lists(const toml::table& section, const std::string& prefix = "") const;
  std::vector<std::pair<std::string, Parameter::Value>> constants(const toml::table& section, const std::string& prefix = "") const;
  /// All entries but `count`.
  std::vector<Distribution> distributions(const toml::table& section, const std::string& prefix = "") const;

 private:
  Distribution distribution(const toml::table& entry, const std::string& name) const;
  std::string file_;
};

}  // namespace musclesim
