#include "expressions.h"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "musclesim/base/parameters.h"

namespace musclesim::description {

/// muParser's messages speak of tokens and offsets; these say what a reader of the file can do.
std::string problemOf(const mu::Parser::exception_type& error, const std::map<std::string, double>& names) {
  if (error.GetCode() != mu::ecUNASSIGNABLE_TOKEN) return error.GetMsg();
  std::vector<std::string> known;
  for (const auto& [name, value] : names) known.push_back(name);
  const std::string nearest = nearestName(error.GetToken(), known);
  return fmt::format("there is no parameter \"{}\"{}; known: {}", error.GetToken(),
                     nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?", fmt::join(known, ", "));
}

Expressions::Expressions(std::map<std::string, double> names) : names_(std::move(names)) {
  parser_.DefineConst("pi", std::numbers::pi);
  for (const auto& [name, number] : names_) parser_.DefineConst(name, number);
}

double Expressions::operator()(const Quantity& quantity) const {
  if (quantity.expression.empty()) return quantity.number;
  double value = 0;
  try {
    parser_.SetExpr(quantity.expression);
    int value_count = 0;
    value = *parser_.Eval(value_count);
    if (value_count != 1) quantity.place.refuse("\"" + quantity.expression + "\" must be one number");
  } catch (const mu::Parser::exception_type& error) {
    quantity.place.refuse("\"" + quantity.expression + "\": " + problemOf(error, names_));
  }
  if (!std::isfinite(value)) quantity.place.refuse(fmt::format("\"{}\" is {}: must be finite", quantity.expression, value));
  return value;
}

Vector Expressions::operator()(const QuantityVector& vector) const {
  return {(*this)(vector[0]), (*this)(vector[1]), (*this)(vector[2])};
}

std::array<double, 2> Expressions::operator()(const std::array<Quantity, 2>& pair) const {
  return {(*this)(pair[0]), (*this)(pair[1])};
}

}  // namespace musclesim::description
