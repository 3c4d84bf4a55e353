/// Column names of a recording: which quantities and units there are, and how they become canonical.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording_info.h"

namespace musclesim {

/// What must be known about the plant before a value in that unit can be converted.
enum class FullScale { none, pressure_kPa, command_V };

/// One column name, understood. canonical value = written value * factor, divided by the full scale if one is needed.
struct Column {
  std::string name;            ///< canonical, for example "length_0_mm"
  std::string quantity;        ///< "time", "command", "pressure", "force", "length", "angle", "hand", "target" or "activity"
  int muscle = -1;             ///< of command, pressure, force and length
  std::string unit;            ///< as written in the header; empty for fractions and pure numbers
  std::string canonical_unit;  ///< empty for fractions and pure numbers
  double factor = 1;
  FullScale full_scale = FullScale::none;
};

/// The muscles a name may count; also keeps every index far inside int.
inline constexpr int largest_muscle_index = 998;

/// Reads a column name. Throws BadParameter that says what is wrong with it and what is allowed.
Column parseColumnName(const std::string& name);

/// parseColumnName for names that the program gives itself: requires canonical units as well.
Column parseCanonicalName(const std::string& name);

/// Requires command_0 .. command_<n-1> without gaps, at least one, and no other column of a muscle that has no command.
/// Returns n. Throws BadParameter.
int requireCommands(const std::vector<Column>& columns);

/// What a value in this column must be divided by, after multiplying by `factor`: the sidecar's full scale, or 1 if none is needed.
/// Throws BadParameter naming the sidecar's member that is missing.
double fullScale(const Column& column, const RecordingInfo& info);

}  // namespace musclesim
