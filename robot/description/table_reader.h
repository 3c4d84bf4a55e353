/// Reads tables of a robot file strictly: every value has a place in the file, and a key that nobody asked for is an error.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace musclesim::description {

/// Where an entry stands in a robot file, for messages.
struct FilePlace {
  std::string file;
  int line = 0, column = 0;
  std::string what;  ///< for example "[[joint]] lever: limits_deg"

  /// Throws BadFile: "file:line:column: what: problem".
  [[noreturn]] void refuse(const std::string& problem) const;
};

/// Throws BadFile for an expression that nobody would write.
void requireShort(const std::string& expression, const FilePlace& place);

/// A number, or an expression over the file's parameters.
struct Quantity {
  double number = 0;
  std::string expression;  ///< empty: the number counts
  FilePlace place;
};
using QuantityVector = std::array<Quantity, 3>;

/// Reads one table key by key. All functions throw BadFile with file, line, key, value and what is allowed.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string file, std::string what);

  bool has(const std::string& key);
  bool isTable(const std::string& key) const;
  std::string text(const std::string& key);
  std::optional<std::string> optionalText(const std::string& key);
  std::string choice(const std::string& key, const std::string& default_value, const std::vector<std::string>& allowed);
  bool flag(const std::string& key, bool default_value);
  double number(const std::string& key);
  std::pair<double, double> range(const std::string& key);
  Quantity quantity(const std::string& key);
  std::optional<Quantity> optionalQuantity(const std::string& key);
  QuantityVector vector(const std::string& key);
  std::optional<QuantityVector> optionalVector(const std::string& key);
  /// A vector, or "x", "y" or "z".
  QuantityVector direction(const std::string& key);
  std::optional<QuantityVector> optionalDirection(const std::string& key);
  std::vector<QuantityVector> vectors(const std::string& key);
  std::optional<std::array<Quantity, 2>> optionalPair(const std::string& key);
  /// A list of numbers or expressions, with any number of entries; empty if there is none.
  std::vector<Quantity> quantities(const std::string& key);
  /// Turns: a list of [angle, axis], the axis as "x", "y", "z" or a vector.
  std::vector<std::pair<Quantity, QuantityVector>> turns(const std::string& key);

  TableReader table(const std::string& key);
  std::optional<TableReader> optionalTable(const std::string& key);
  /// The tables of [[key]]; none if the key is missing.
  std::vector<TableReader> tables(const std::string& key);
  /// All keys of the table whose values are numbers, expressions or texts, as asked for.
  std::vector<std::string> keys() const;

  /// Throws for the first key that nobody asked for, with the nearest one that is known.
  void requireNoOthers() const;
  FilePlace place(const std::string& key = "") const;
  /// Adds a name to the place in messages, for example of a joint.
  void setName(const std::string& name) { what_ += " " + name; }

 private:
  const toml::node* find(const std::string& key);
  const toml::node& need(const std::string& key, const std::string& kind);
  FilePlace placeOf(const toml::node& node, const std::string& key) const;
  Quantity quantityOf(const toml::node& node, const std::string& key) const;
  template <std::size_t count>
  std::array<Quantity, count> listOf(const toml::node& node, const std::string& key) const;
  QuantityVector axisOf(const toml::node& node, const std::string& key) const;

  const toml::table* table_;
  std::string file_, what_;
  std::vector<std::string> asked_;
};

}  // namespace musclesim::description
