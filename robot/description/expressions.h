/// Values of expressions over named numbers.
#pragma once

#include <muParser.h>

#include <array>
#include <map>
#include <string>

#include "musclesim/robot/state.h"
#include "table_reader.h"

namespace musclesim::description {

/// What a reader of the file can do about an error of muParser.
std::string problemOf(const mu::ParserError& error, const std::map<std::string, double>& names);

/// Evaluates quantities with muParser: + - * / ^, parentheses, sqrt, sin, cos (radians) and its like, the constant pi, and the names given.
class Expressions {
 public:
  explicit Expressions(std::map<std::string, double> names) : names_(std::move(names)) {}

  /// Throws BadFile for an expression that cannot be read, has an unknown name or is not finite.
  double operator()(const Quantity& quantity) const;
  Vector operator()(const QuantityVector& vector) const;
  std::array<double, 2> operator()(const std::array<Quantity, 2>& pair) const;
  const std::map<std::string, double>& names() const { return names_; }

 private:
  std::map<std::string, double> names_;
};

}  // namespace musclesim::description
