/// The entries of a plan's sections: lists of values, and distributions to draw from.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <utility>
#include <vector>

#include "musclesim/base/random.h"
#include "sweep/sweep.h"

namespace musclesim {

/// What a parameter's values are drawn from.
struct Distribution {
  std::string name;
  double low = 0, high = 1;
  bool log = false;                       ///< uniform in the logarithm
  bool integer = false;                   ///< whole numbers low .. high
  std::vector<Parameter::Value> choices;  ///< instead of a range

  /// The value at a place 0 <= unit < 1 of the distribution.
  Parameter::Value at(double unit) const;
};

/// Walks through a section; throws BadFile at what it cannot accept.
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
  /// Names joined by dots and their lists of values.
  std::vector<std::pair<std::string, Values>> lists(const toml::table& section, const std::string& prefix = "") const;
  std::vector<std::pair<std::string, Parameter::Value>> constants(const toml::table& section, const std::string& prefix = "") const;
  /// All entries but `count`.
  std::vector<Distribution> distributions(const toml::table& section, const std::string& prefix = "") const;

 private:
  Distribution distribution(const toml::table& entry, const std::string& name) const;
  std::string file_;
};

}  // namespace musclesim
