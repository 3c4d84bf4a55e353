/// Named parameters of the model. The code that uses a parameter declares it; users override it by name.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace musclesim {

/// One declared parameter with everything a user needs to know about it.
struct Parameter {
  using Value = std::variant<double, std::string>;
  std::string name;  ///< "group.name_unit", for example "muscle.bead_mass_g"
  Value value;       ///< the value that is used now
  Value default_value;
  std::string unit;  ///< empty for pure numbers and choices
  double minimum = 0, maximum = 0;
  std::vector<std::string> choices;  ///< empty for numbers
  bool integer = false;
  std::string description;
};

/// Largest tolerance of a parameter, the relative standard deviation of what is known about it. Of a number that is 2 times its own size
/// off not even the order of magnitude is known.
inline constexpr double largest_tolerance = 2;

/// Whether 0 < tolerance <= largest_tolerance.
inline bool isTolerance(double tolerance) {
  return tolerance > 0 && tolerance <= largest_tolerance;
}

/// A set of overrides (from --set, --config, a recording's sidecar) and the record of all parameters declared so far.
///
/// A component declares and reads in one call, so name, unit, default, range and meaning stand in exactly one place:
///     bead_mass_g = parameters.number("muscle.bead_mass_g", 10, "g", 0.01, 1e4, "mass of one bead");
/// Declaring the same name again returns the value that is used already.
/// number, integer and choice throw BadParameter when the override is not a number, not finite, out of range or not among the choices.
class Parameters {
 public:
  /// Overrides one parameter. `source` is named in errors ("--set", "model.toml:12").
  /// A later call replaces an earlier one. Throws BadParameter for an empty name or, once declared, for a value out of range.
  void set(const std::string& name, const Parameter::Value& value, const std::string& source);
  /// As set(), for a value from a line of a file (0: from the file as a whole). Throws BadFile instead of BadParameter.
  void setFromFile(const std::string& name, const Parameter::Value& value, const std::string& file, int line = 0);
  /// Calls set() for every override of another set.
  void setAll(const Parameters& others);
  /// Overrides from text like "name=value" (--set). The value is a number if the text is one. Throws BadParameter if there is no "=".
  void setFromText(const std::string& assignment, const std::string& source);
  /// Overrides from all keys of a TOML file; tables become groups. Throws BadFile with line and column, IoError if it cannot be read.
  void readToml(const std::string& file);

  double number(const std::string& name, double default_value, const std::string& unit, double minimum, double maximum,
                const std::string& description);
  int integer(const std::string& name, int default_value, int minimum, int maximum, const std::string& description);
  std::string choice(const std::string& name, const std::string& default_value, const std::vector<std::string>& choices,
                     const std::string& description);

  /// All parameters declared so far, in order of declaration.
  const std::vector<Parameter>& declared() const { return declared_; }
  /// Throws BadParameter if an override has no declared parameter; the message gives its name and the nearest declared name.
  void requireAllKnown() const;
  /// Drops overrides from files that nothing has declared, if their group (the name up to the first dot) is one of these. Returns their
  /// names.
  std::vector<std::string> dropUnknownOfFiles(const std::vector<std::string>& groups);
  /// Throws BadParameter if a relative tolerance of this parameter has no meaning: it is not declared (the message gives the nearest
  /// declared name), a choice or a whole number, or 0, which no factor changes.
  void requireScalable(const std::string& name) const;
  /// The declared parameters as a TOML file that readToml accepts, with unit, range and meaning as comments.
  std::string toToml() const;

 private:
  struct Override {
    std::string name;
    Parameter::Value value;
    std::string source;
    std::string file = {};  ///< empty: not from a file
    int line = 0;
  };
  void add(Override given);
  [[noreturn]] static void refuse(const Override& given, const std::string& what);
  std::string unknownText(const std::string& name) const;
  const Parameter* find(const std::string& name) const;
  const Override* overrideOf(const std::string& name) const;
  static bool allows(const Parameter& parameter, const Parameter::Value& value);
  static void requireAllowed(const Parameter& parameter, const Override& given);
  const Parameter& declare(Parameter parameter);

  std::vector<Override> overrides_;
  std::vector<Parameter> declared_;
};

/// The entry of `names` with the smallest edit distance to `name`; empty if none is close (more than half of the letters differ).
std::string nearestName(const std::string& name, const std::vector<std::string>& names);

}  // namespace musclesim
