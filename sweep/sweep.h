/// Sweeps: many runs of the program, one per row, shared by any number of workers on any number of machines.
///
/// A sweep is a folder:
///     manifest.json      every row: parameters by name; program version; hash of the robots; never changed once written
///     inputs/            copies of the files that rows read
///     claims/ workers/   which worker works on which row (claims.h)
///     outputs/ROW/       the output files of a row's run, with its stdout.txt and stderr.txt
///     results/ROW.json   the row's result; written atomically when the row has ended
///     collected.csv .json
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// Arguments of one run and the parameters that are substituted in them.
struct SweepRow {
  std::vector<std::pair<std::string, Parameter::Value>> parameters;
  std::vector<std::string> command;  ///< command of this row; empty: the command of the sweep
};

/// The runs of a sweep, as in manifest.json.
struct Sweep {
  /// Arguments of `musclesim`, which runs in the sweep's folder. {name} stands for a row's parameter, {out} for the folder that the row may
  /// write to, {row} for its number. Parameters with a dot in the name that no {name} uses are passed as --set name=value.
  std::vector<std::string> command;
  /// The JSON file in {out} that holds the row's numbers; empty: they are in the last line of standard output, if it is a JSON object.
  std::string result_file;
  /// The numbers to collect, by dotted name ("verdict.rmse", "effects.0.id"; a * at the end matches anything); empty: all numbers that are
  /// not in lists.
  std::vector<std::string> columns;
  double row_time_limit_s = 0;                ///< wall time after which a run counts as crashed; 0: none
  std::uint64_t seed = 1;                     ///< seed of the random choices of the plan
  std::string program;                        ///< "musclesim 0.1.0"; writeSweep fills it in if empty
  std::string robots_hash;                    ///< robotsHash(); writeSweep fills it in if empty
  std::map<std::string, std::string> inputs;  ///< path in the sweep's folder -> hash of the contents
  std::vector<SweepRow> rows;
};

constexpr std::size_t most_sweep_rows = 100'000, most_sweep_values = 1'000'000;  ///< a larger plan is refused

/// The arguments of row `number` after substitution. Throws BadParameter for a {name} that is not a parameter of the row and for a
/// parameter that the command does not use.
std::vector<std::string> argumentsOf(const Sweep& sweep, std::size_t number, const std::string& out_folder);

/// Copies an input file of rows into the sweep's folder; for a recording NAME.csv also NAME.json. Returns the path of the copy, for use as
/// a parameter's value. Throws IoError, BadFile.
std::string addInput(Sweep& sweep, const std::string& folder, const std::string& file);

/// Writes manifest.json and the sub-folders. Throws BadParameter if the folder already holds a sweep or if the substitution fails for a
/// row; IoError.
void writeSweep(Sweep sweep, const std::string& folder);

/// Reads manifest.json strictly. Throws BadFile, IoError.
Sweep readSweep(const std::string& folder);
Sweep parseSweep(const std::string& text, const std::string& file);

/// Number and name of a row as used in the folder: "000017".
std::string rowName(std::size_t row);

/// A value as text in a command.
std::string valueText(const Parameter::Value& value);
/// A value for JSON files and tables; whole numbers have no decimal point.
nlohmann::ordered_json valueJson(const Parameter::Value& value);

}  // namespace musclesim
