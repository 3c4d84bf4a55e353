/// Column names of a recording: the known quantities and units, and their conversion to canonical units.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording_info.h"

namespace musclesim {

/// The full-scale value of the plant that is needed to convert a unit to fractions.
enum class FullScale { none, pressure_kPa, command_V };

/// A parsed column name. canonical value = written value * factor, divided by the full scale if one is needed.
struct Column {
  std::string name;            ///< canonical, for example "length_0_mm"
  std::string quantity;        ///< "time", "command", "pressure", "force", "length", "angle", "hand", "target", "activity" or "controller"
  int muscle = -1;             ///< index, for command, pressure, force and length; -1 otherwise
  std::string unit;            ///< as written in the header; empty for fractions and pure numbers
  std::string canonical_unit;  ///< empty for fractions and pure numbers
  double factor = 1;
  FullScale full_scale = FullScale::none;
};

/// The largest muscle index that a name may have.
inline constexpr int largest_muscle_index = 998;

/// Reads a column name. Throws BadParameter that says what is wrong with it and what is allowed.
Column parseColumnName(const std::string& name);

/// parseColumnName for names made by the program: requires canonical units, too.
Column parseCanonicalName(const std::string& name);

/// Requires command_0 .. command_<n-1> without gaps, at least one, and that every other muscle column belongs to a muscle with a command.
/// Returns n. Throws BadParameter.
int requireCommands(const std::vector<Column>& columns);

/// The divisor of a value in this column, after multiplying by `factor`: the sidecar's full scale, or 1 if none is needed.
/// Throws BadParameter naming the sidecar's member that is missing.
double fullScale(const Column& column, const RecordingInfo& info);

}  // namespace musclesim
