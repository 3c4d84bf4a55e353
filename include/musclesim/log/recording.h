/// Recordings: the commands and measurements of one run of one plant, real or simulated.
///
/// Two files with one stem: NAME.csv (one row per sample) and NAME.json (the sidecar). Format `musclesim-recording-1`.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording_info.h"
#include "musclesim/log/signal_unit.h"

namespace musclesim {

/// One signal over time. Values are in the canonical unit of the quantity; NaN means "not measured at that sample".
struct Signal {
  std::string name;  ///< canonical column name, for example "length_0_mm", "command_3", "angle_elbow_deg", "hand_y_mm", "activity"
  std::vector<double> values;
};

/// A recording. Simulated and measured runs have the same type.
struct Recording {
  std::string file;  ///< the file it was read from, for messages; empty if it was made in memory
  RecordingInfo info;
  std::vector<double> time_s;      ///< strictly increasing
  std::vector<Signal> signals;     ///< each has as many values as time_s
  std::vector<std::string> notes;  ///< messages for the user: what the reader converted, skipped or found unusual

  /// Number of commanded muscles.
  int muscleCount() const;
  /// The signal of that name, or null.
  const Signal* find(const std::string& name) const;
};

struct ReadOptions {
  std::vector<std::string> ignore_columns;
};

/// Reads NAME.csv and NAME.json beside it, strictly: throws BadFile that names file, line, column and what is allowed (also if there is no
/// sidecar); IoError if the CSV file cannot be read. Converts the units in the header to the canonical ones (mm, deg, N, fraction of full
/// scale). If the sidecar says "complete": false, an unfinished last line (without line end) is dropped with a note.
Recording readRecording(const std::string& csv_file, const ReadOptions& options = {});

/// Like readRecording, from text in memory; the names are used in messages only.
Recording parseRecording(const std::string& csv_text, const std::string& csv_name, const std::string& json_text,
                         const std::string& json_name, const ReadOptions& options = {});

/// Writes both files, each under a temporary name that is then renamed. Reading them again gives the same bits.
/// Throws IoError; BadParameter, before anything is written, for a recording that readRecording would refuse.
void writeRecording(const Recording& recording, const std::string& csv_file);

/// The sidecar's path for a recording's CSV path ("a/b.csv" -> "a/b.json").
std::string sidecarPath(const std::string& csv_file);

}  // namespace musclesim
