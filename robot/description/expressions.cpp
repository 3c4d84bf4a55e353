#include "expressions.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>
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

namespace {

/// The expressions that this thread has read, with the names as variables: a diagnosis builds one robot thousands of times with other
/// numbers, and reading an expression takes much longer than evaluating it.
class ReadExpressions {
 public:
  /// The value of an expression, and how many values it has. Throws as muParser does.
  std::pair<double, int> valueOf(const std::string& expression, const std::map<std::string, double>& names) {
    if (numbers_ != names) take(names);
    if (parsers_.size() >= most_kept) parsers_.clear();
    std::unique_ptr<mu::Parser>& parser = parsers_[expression];
    if (parser) return valueOf(*parser);
    if (assigns(expression)) throw mu::ParserError("\"=\" would change a parameter; to compare is \"==\"");
    auto fresh = std::make_unique<mu::Parser>();
    fresh->EnableOptimizer(false);  // it rearranges sums, which changes the last digits
    if (!names.contains("pi")) fresh->DefineConst("pi", std::numbers::pi);
    for (auto& [name, number] : numbers_) fresh->DefineVar(name, &number);
    fresh->SetExpr(expression);
    const std::pair<double, int> result = valueOf(*fresh);
    if (result.second == 1) parser = std::move(fresh);
    return result;
  }

 private:
  void take(const std::map<std::string, double>& names) {
    const auto isSameName = [](const auto& a, const auto& b) { return a.first == b.first; };
    if (!std::ranges::equal(numbers_, names, isSameName)) {
      parsers_.clear();
      numbers_ = names;
    }
    for (auto& [name, number] : numbers_) number = names.at(name);
  }
  /// Whether there is a "=" that is no part of a comparison.
  static bool assigns(const std::string& expression) {
    for (std::size_t at = expression.find('='); at != std::string::npos; at = expression.find('=', at + 1)) {
      if (at + 1 < expression.size() && expression[at + 1] == '=')
        ++at;
      else if (at == 0 || std::string("<>!").find(expression[at - 1]) == std::string::npos)
        return true;
    }
    return false;
  }
  static std::pair<double, int> valueOf(mu::Parser& parser) {
    int value_count = 0;
    const double value = *parser.Eval(value_count);
    return {value, value_count};
  }

  static constexpr std::size_t most_kept = 2000;  ///< more than any robot has; thousands of robots in one process need not stay

  std::map<std::string, double> numbers_;  ///< the variables of all parsers, which hold pointers to the values
  std::unordered_map<std::string, std::unique_ptr<mu::Parser>> parsers_;
};

}  // namespace

double Expressions::operator()(const Quantity& quantity) const {
  if (quantity.expression.empty()) return quantity.number;
  thread_local ReadExpressions read;
  double value = 0;
  try {
    int value_count = 0;
    std::tie(value, value_count) = read.valueOf(quantity.expression, names_);
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
