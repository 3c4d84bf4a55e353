#include "musclesim/log/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>

#include "columns.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/log/csv.h"
#include "row_text.h"
#include "sidecar.h"

namespace musclesim {

namespace {

constexpr std::size_t largest_sidecar_bytes = std::size_t{4} << 20;
/// A measured pressure outside these fractions of full scale more likely has a wrong unit than a sensor error.
constexpr double plausible_pressure_minimum = -0.5, plausible_pressure_maximum = 1.5;

/// A column of the file that becomes a signal (or the time).
struct ColumnInUse {
  Column column;
  std::size_t cell_index = 0;
  double divisor = 1;
};

/// Reads one CSV text into a recording whose sidecar is known already.
class TableReader {
 public:
  TableReader(std::string_view text, const std::string& file, const ReadOptions& options, Recording& recording)
      : csv_(text, file), file_(file), options_(options), recording_(recording) {}

  void read() {
    readHeader();
    readRows();
    addNotes();
  }

 private:
  void readHeader();
  void addColumn(const CsvCell& cell, std::size_t cell_index);
  void requireTimeAndCommands();
  void readRows();
  void readTime(const CsvCell& cell, const ColumnInUse& use);
  double readValue(const CsvCell& cell, const ColumnInUse& use) const;
  void addNotes();
  void noteSlowRows();

  CsvReader csv_;
  const std::string& file_;
  const ReadOptions& options_;
  Recording& recording_;
  std::vector<ColumnInUse> columns_;  ///< in the order of the file; the time is not among the recording's signals
  std::vector<CsvCell> header_cells_;
};

void TableReader::readHeader() {
  const auto isIgnored = [&](std::string_view name) {
    return std::find(options_.ignore_columns.begin(), options_.ignore_columns.end(), name) != options_.ignore_columns.end();
  };
  std::string ignored;
  for (std::size_t i = 0; i < csv_.header().size(); ++i) {
    const auto& cell = csv_.header()[i];
    if (!isIgnored(cell.text)) addColumn(cell, i);
    if (isIgnored(cell.text)) ignored += (ignored.empty() ? "" : ", ") + std::string(cell.text);
  }
  if (!ignored.empty()) recording_.notes.push_back("columns ignored on request: " + ignored);
  for (const std::string& name : options_.ignore_columns)
    if (std::ranges::none_of(csv_.header(), [&](const CsvCell& cell) { return cell.text == name; }))
      recording_.notes.push_back("there is no column " + name + " to ignore");
  requireTimeAndCommands();
}

void TableReader::addColumn(const CsvCell& cell, std::size_t cell_index) {
  try {
    ColumnInUse use{parseColumnName(std::string(cell.text)), cell_index, 1};
    use.divisor = fullScale(use.column, recording_.info);
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].column.name == use.column.name)
        csv_.refuse(cell, fmt::format("column {} is given twice (already in column {} as {})", inQuotes(cell.text), header_cells_[i].column,
                                      inQuotes(header_cells_[i].text)));
    columns_.push_back(use);
    header_cells_.push_back(cell);
  } catch (const BadParameter& error) {
    csv_.refuse(cell, error.what());
  }
}

void TableReader::requireTimeAndCommands() {
  const CsvCell start_of_header{"", csv_.headerLine(), 1};
  const bool has_time = std::any_of(columns_.begin(), columns_.end(), [](const auto& use) { return use.column.quantity == "time"; });
  if (!has_time) csv_.refuse(start_of_header, "there is no column time_s: every recording needs the time in seconds");
  std::vector<Column> columns;
  for (const auto& use : columns_) columns.push_back(use.column);
  try {
    requireCommands(columns);
  } catch (const BadParameter& error) {
    csv_.refuse(start_of_header, error.what());
  }
}

void TableReader::readRows() {
  recording_.signals.clear();
  for (const auto& use : columns_)
    if (use.column.quantity != "time") recording_.signals.push_back({use.column.name, {}});
  std::vector<CsvCell> cells;
  while (csv_.readRow(cells)) {
    std::size_t signal = 0;
    for (const auto& use : columns_) {
      const auto& cell = cells[use.cell_index];
      if (use.column.quantity == "time")
        readTime(cell, use);
      else
        recording_.signals[signal++].values.push_back(readValue(cell, use));
    }
  }
  if (recording_.time_s.empty())
    throw BadFile(file_, csv_.headerLine(), 0, "there is no row below the header: a recording needs at least one sample");
}

void TableReader::readTime(const CsvCell& cell, const ColumnInUse& use) {
  const double time_s = csv_.number(cell, use.column.name);
  if (std::isnan(time_s)) csv_.refuse(cell, "time_s is not given: every row needs its time");
  if (!recording_.time_s.empty() && !(time_s > recording_.time_s.back()))
    csv_.refuse(cell, fmt::format("time_s = {} s: must be later than the row before ({} s); the time must be strictly increasing", time_s,
                                  recording_.time_s.back()));
  recording_.time_s.push_back(time_s);
}

double TableReader::readValue(const CsvCell& cell, const ColumnInUse& use) const {
  const auto& column = use.column;
  const double written = csv_.number(cell, csv_.header()[use.cell_index].text);
  const double value = written * column.factor / use.divisor;
  if (std::isinf(value))
    csv_.refuse(cell, fmt::format("column {}: {} is too large for a double in the canonical unit", column.name, inQuotes(cell.text)));
  if (column.quantity != "command") return value;
  if (std::isnan(value)) csv_.refuse(cell, fmt::format("{} is not given: every row needs every muscle's command", column.name));
  if (value < -command_slack_ratio || value > 1 + command_slack_ratio)
    csv_.refuse(cell, fmt::format("{} = {} ({} of full scale): must lie in 0 .. 1 of full scale", csv_.header()[use.cell_index].text,
                                  cell.text, value));
  return value < 0 || value > 1 ? std::clamp(value, 0.0, 1.0) : value;
}

void TableReader::addNotes() {
  std::map<std::string, std::string> converted;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto& use = columns_[i];
    if (use.column.unit == use.column.canonical_unit) continue;
    std::string into = use.column.canonical_unit;
    if (use.column.full_scale != FullScale::none)
      into = fmt::format("fractions of {} {}", use.divisor, use.column.full_scale == FullScale::command_V ? "V" : "kPa");
    std::string& names = converted[fmt::format("converted from {} to {}: ", use.column.unit, into)];
    names += (names.empty() ? "" : ", ") + std::string(header_cells_[i].text);
  }
  for (const auto& [conversion, names] : converted) recording_.notes.push_back(conversion + names);
  for (const auto& [name, deviation] : recording_.info.noise_std)
    if (!recording_.find(name)) recording_.notes.push_back("noise_std names " + name + ", which is not a column of this recording");
  noteSlowRows();
  for (const auto& signal : recording_.signals) {
    const bool is_empty = std::all_of(signal.values.begin(), signal.values.end(), [](double value) { return std::isnan(value); });
    if (is_empty) recording_.notes.push_back(signal.name + " has no value in any row");
    if (!signal.name.starts_with("pressure_")) continue;
    const auto odd = std::find_if(signal.values.begin(), signal.values.end(),
                                  [](double value) { return value < plausible_pressure_minimum || value > plausible_pressure_maximum; });
    if (odd != signal.values.end())
      recording_.notes.push_back(fmt::format("{} reaches {} of full scale: is its unit right?", signal.name, *odd));
  }
}

/// Warns of long steps: if time_s were in milliseconds, a replay would take hours.
void TableReader::noteSlowRows() {
  constexpr double slow_s = 2;
  const std::vector<double>& time_s = recording_.time_s;
  if (time_s.size() < 3) return;
  std::vector<double> steps_s(time_s.size());
  std::adjacent_difference(time_s.begin(), time_s.end(), steps_s.begin());
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin() + 1, middle, steps_s.end());
  if (*middle > slow_s) recording_.notes.push_back(fmt::format("typical rows are {:g} s apart: is time_s in seconds?", *middle));
}

/// Drops a last line without line end if the sidecar says that the writer did not finish.
std::string_view withoutTornLine(std::string_view text, Recording& recording) {
  if (recording.info.complete.value_or(true)) return text;
  recording.notes.push_back("the sidecar says \"complete\": false: the run stopped early or is still being recorded");
  if (text.empty() || text.ends_with('\n')) return text;
  const auto line_begin = text.rfind('\n') == std::string_view::npos ? 0 : text.rfind('\n') + 1;
  recording.notes.push_back(fmt::format("dropped the unfinished last line {}", inQuotes(text.substr(line_begin))));
  return text.substr(0, line_begin);
}

std::string csvText(const Recording& recording) {
  std::vector<std::string> names;
  for (const auto& signal : recording.signals) {
    names.push_back(signal.name);
    if (signal.values.size() != recording.time_s.size())
      throw BadParameter(signal.name, fmt::format("{} values", signal.values.size()),
                         fmt::format("have one value for each of the {} times", recording.time_s.size()));
  }
  if (recording.time_s.empty()) throw BadParameter("a recording needs at least one sample");
  RowText rows(names);
  std::string text = rows.header();
  std::vector<double> values(names.size());
  for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = recording.signals[i].values[row];
    rows.append(text, recording.time_s[row], values);
  }
  return text;
}

}  // namespace

int Recording::muscleCount() const {
  return static_cast<int>(
      std::count_if(signals.begin(), signals.end(), [](const Signal& signal) { return signal.name.starts_with("command_"); }));
}

const Signal* Recording::find(const std::string& name) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const Signal& signal) { return signal.name == name; });
  return found == signals.end() ? nullptr : &*found;
}

Recording parseRecording(const std::string& csv_text, const std::string& csv_name, const std::string& json_text,
                         const std::string& json_name, const ReadOptions& options) {
  Recording recording;
  recording.file = csv_name;
  recording.info = parseSidecar(json_text, json_name, options.ignore_columns, recording.notes);
  TableReader(withoutTornLine(csv_text, recording), csv_name, options, recording).read();
  return recording;
}

Recording readRecording(const std::string& csv_file, const ReadOptions& options) {
  const std::string json_file = sidecarPath(csv_file);
  if (json_file == csv_file) throw BadFile(csv_file, "is a sidecar: name the recording's .csv file");
  const std::string csv_text = readTextFile(csv_file, CsvLimits().file_bytes);
  std::error_code ignored;
  if (std::filesystem::status(json_file, ignored).type() == std::filesystem::file_type::not_found)
    throw BadFile(json_file,
                  fmt::format("does not exist, but {} needs this sidecar. It must hold at least {{\"format\": \"{}\", \"robot\": "
                              "\"rig\"}} with the name of the robot",
                              csv_file, recording_format));
  return parseRecording(csv_text, csv_file, readTextFile(json_file, largest_sidecar_bytes), json_file, options);
}

void writeRecording(const Recording& recording, const std::string& csv_file) {
  const std::string json_file = sidecarPath(csv_file);
  if (json_file == csv_file) throw BadParameter("recording file", csv_file, "end in .csv (the sidecar gets the .json)");
  const std::string json_text = sidecarText(recording.info, json_file);
  const std::string csv_text = csvText(recording);
  FileReplacement csv(csv_file, csv_text);
  FileReplacement json(json_file, json_text);
  // A process that is killed between the two must not leave new readings with an old sidecar: without a sidecar they are refused.
  std::error_code absent;
  std::filesystem::remove(json_file, absent);
  csv.commit();
  json.commit();
}

std::string sidecarPath(const std::string& csv_file) {
  return std::filesystem::path(csv_file).replace_extension(".json").string();
}

}  // namespace musclesim
