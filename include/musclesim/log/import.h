/// Turns measured tables into recordings, by a mapping file.
#pragma once

#include <string>

#include "musclesim/log/import_mapping.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// The path of the table that a column names; it is relative to the folder of the first table.
std::string tableFile(const std::string& csv_file, const ImportColumn& column);

/// Turns the table into a recording. Nothing is invented: a reading is missing outside of its table's times and in gaps, and notes count
/// such rows; rows that repeat the time of the row before (a coarse clock) are left out with a note.
/// Throws BadFile if the table lacks a column that the mapping names, if the clocks of two tables do not overlap, or if the result is not a
/// valid recording. Every message has the place in the table, or in the mapping, where the fault stands.
Recording importTable(const std::string& csv_file, const ImportMapping& mapping);

}  // namespace musclesim
