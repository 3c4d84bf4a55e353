#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <set>
#include <utility>

#include "matlab.h"
#include "musclesim/base/text.h"
#include "table_look.h"

namespace musclesim {

namespace {

/// A text as TOML writes it.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      out += c == '\t' ? "\\t" : fmt::format("\\u{:04X}", static_cast<int>(c));
    else
      out += c;
  }
  return out + "\"";
}

/// The column as a mapping names it: its name, or its number where the name does not tell it from others.
std::string reference(const TableLook& look, std::size_t column) {
  return look.columns[column].is_named ? quoted(look.columns[column].name) : fmt::format("{}", column + 1);
}

std::string separatorName(char separator) {
  switch (separator) {
    case ' ':
      return "blanks";
    case '\t':
      return "tabs";
    default:
      return fmt::format("\"{}\"", separator);
  }
}

/// Ambient pressure in hPa lies in this range near sea level and on most hills.
bool looksAbsolute(const LookedColumn& column) {
  constexpr double lowest_hPa = 900, highest_hPa = 1060;
  const double in_hPa = column.unit == "kPa"   ? 10
                        : column.unit == "bar" ? 1000
                        : column.unit == "Pa"  ? 0.01
                        : column.unit == "psi" ? 68.94757
                                               : 1;
  const bool is_called_pressure =
      column.name.starts_with('p') || column.name.starts_with('P') || column.name.find("ress") != std::string::npos;
  const bool may_be_pressure = (column.unit.empty() && is_called_pressure) || in_hPa != 1 || column.unit == "hPa" || column.unit == "mbar";
  return column.is_number && may_be_pressure && column.lowest * in_hPa > lowest_hPa && column.lowest * in_hPa < highest_hPa;
}

/// The range with as many digits as tell its ends apart, and without exponents where it need not have them.
std::string rangeText(double lowest, double highest) {
  constexpr int fewest = 6, most = 15, of_the_span = 4, of_a_constant = 12;
  const double largest = std::max(std::abs(lowest), std::abs(highest)), span = highest - lowest;
  const int whole = largest >= 1 ? static_cast<int>(std::log10(largest)) + 1 : 0;
  const int telling = span > 0 ? static_cast<int>(std::ceil(std::log10(largest / span))) + of_the_span : of_a_constant;
  const int digits = std::clamp(std::max(whole, telling), fewest, most);
  return fmt::format("{:.{}g} .. {:.{}g}", lowest, digits, highest, digits);
}

/// The range of a clock that counts from 1970, as dates.
std::string dateText(const LookedColumn& column, const LookedClock& clock) {
  constexpr double epoch_s = 1e8, latest_s = 1e10;
  const double from_s = column.lowest * clock.clock.factor, until_s = column.highest * clock.clock.factor;
  if (!column.is_number || from_s < epoch_s || until_s > latest_s) return "";
  const auto shown = [](double time_s) {
    const auto seconds = static_cast<std::time_t>(time_s);
    std::tm time{};
    gmtime_r(&seconds, &time);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &time);
    return std::string(text);
  };
  return fmt::format(" ({} .. {} UTC)", shown(from_s), shown(until_s));
}

std::string describe(const LookedColumn& column) {
  if (column.example.empty()) return "empty";
  if (!column.is_number) return fmt::format("text, first {}", inQuotes(column.example));
  std::string text = rangeText(column.lowest, column.highest);
  if (!column.unit.empty()) text += " " + column.unit;
  if (looksAbsolute(column)) text += column.unit.empty() ? ", hPa or mbar, absolute?" : ", absolute?";
  if (column.missing_count > 0) text += fmt::format(", {} missing", column.missing_count);
  if (column.is_repeated) text += ", another column has the same name: refer to it by its number";
  return text;
}

std::string describe(const LookedClock& clock) {
  if (!clock.fault.empty()) return "clock, but " + clock.fault;
  std::string text =
      fmt::format("clock{}: every {:.4g} s over {:.6g} s", clock.unit_is_guessed && !clock.unit.empty() ? " in " + clock.unit + "?" : "",
                  clock.step_s, clock.duration_s);
  if (clock.unit.empty()) text = "clock: the row's number; give rate_Hz";
  if (clock.clock.wraps_at_s > 0) text += fmt::format(", begins again at {:.12g} s", clock.clock.wraps_at_s);
  if (clock.gap_count > 0) text += fmt::format(", {} gaps, the longest {:.4g} s", clock.gap_count, clock.longest_gap_s);
  if (clock.repeat_count > 0)
    text += fmt::format(", {} the time of the row before",
                        clock.repeat_count == 1 ? "1 row has" : fmt::format("{} rows have", clock.repeat_count));
  return text;
}

std::string formatMembers(const TableFormat& format) {
  const TableFormat plain;
  std::string text;
  if (format.separator != plain.separator) text += fmt::format("separator = {}\n", quoted(std::string(1, format.separator)));
  if (format.decimal != plain.decimal) text += fmt::format("decimal = \"{}\"\n", format.decimal);
  if (!format.has_header) text += "header = false\n";
  if (format.skip_before_header > 0) text += fmt::format("skip_before_header = {}\n", format.skip_before_header);
  if (format.skip_after_header > 0) text += fmt::format("skip_after_header = {}   # a row of units\n", format.skip_after_header);
  if (format.comment != plain.comment) text += fmt::format("comment = {}\n", quoted(format.comment));
  if (!format.encoding.empty()) text += fmt::format("encoding = {}   # or another one-byte encoding\n", quoted(format.encoding));
  std::string words;
  for (const std::string& word : format.missing) words += (words.empty() ? "" : ", ") + quoted(word);
  if (!words.empty()) text += fmt::format("missing = [{}]\n", words);
  return text.empty() ? "" : "\n[table]                              # how the file is written\n" + text;
}

std::string clockLine(const TableLook& look) {
  if (!look.clock) return "# no clock was recognised\ntime_s = { rate_Hz = 100 }           # rows per second";
  const LookedClock& clock = *look.clock;
  const std::string from = reference(look, clock.column);
  if (clock.unit.empty()) return fmt::format("time_s = {{ from = {}, rate_Hz = 100 }}   # {}", from, describe(clock));
  std::string members;
  if (!clock.clock.date.empty()) members += ", date = " + reference(look, static_cast<std::size_t>(clock.clock.date.number) - 1);
  if (!clock.clock.format.empty()) members += ", format = " + quoted(clock.clock.format);
  if (clock.clock.wraps_at_s > 0) members += fmt::format(", wraps_at_s = {:.12g}", clock.clock.wraps_at_s);
  const bool is_plain = members.empty() && look.columns[clock.column].is_named;
  return fmt::format("time_{} = {}   # {}", clock.unit, is_plain ? from : "{ from = " + from + members + " }", describe(clock));
}

/// Whether a word of the name says that the values were asked for, not measured: "p_set_1", "pressureCmd", "Soll_bar".
bool isCalledCommand(const std::string& name) {
  static const std::set<std::string> words = {"set",    "setpoint", "sp",      "cmd",  "command",  "commanded", "ref",     "reference",
                                              "target", "des",      "desired", "soll", "sollwert", "demand",    "demanded"};
  std::string word;
  bool was_capital = false;
  for (const char c : name + "_") {
    const bool is_capital = c >= 'A' && c <= 'Z', is_letter = is_capital || (c >= 'a' && c <= 'z');
    if ((!is_letter || (is_capital && !was_capital)) && words.contains(std::exchange(word, ""))) return true;
    if (is_letter) word += static_cast<char>(is_capital ? c - 'A' + 'a' : c);
    was_capital = is_capital;
  }
  return false;
}

/// Columns of recordings for names and units, every name once.
class Suggestions {
 public:
  std::string next(const LookedColumn& column) {
    const std::string& unit = column.unit;
    const auto is_one_of = [&](std::initializer_list<const char*> units) { return std::ranges::find(units, unit) != units.end(); };
    const bool is_pressure = is_one_of({"kPa", "bar", "MPa", "Pa", "hPa", "mbar", "psi"});
    if (unit == "V" || (is_pressure && isCalledCommand(column.name))) return fmt::format("command_{}_{}", commands_++, unit);
    if (is_pressure) return fmt::format("pressure_{}_{}", pressures_++, unit);
    if (is_one_of({"mm", "cm", "m", "um", "inch"})) return fmt::format("length_{}_{}", lengths_++, unit);
    if (is_one_of({"N", "mN", "kN", "kgf", "lbf"})) return fmt::format("force_{}_{}", forces_++, unit);
    if (!is_one_of({"deg", "rad"})) return "...";
    return fmt::format("angle_{}_{}", angles_++ == 0 ? "elbow" : fmt::format("joint{}", angles_), unit);
  }

  bool haveCommands() const { return commands_ > 0; }

 private:
  int pressures_ = 0, commands_ = 0, lengths_ = 0, forces_ = 0, angles_ = 0;
};

}  // namespace

std::string lookText(const TableLook& look) {
  const TableFormat& format = look.format;
  std::string text;
  if (!isMatlabFile(look.file)) {
    text =
        fmt::format("cells      separated by {}, decimal {}\n", separatorName(format.separator), format.decimal == '.' ? "point" : "comma");
    text += format.has_header
                ? fmt::format("header     line {}{}\n", look.header_line, format.skip_after_header > 0 ? ", units below it" : "")
                : "header     none: columns by number\n";
    if (!format.encoding.empty()) text += fmt::format("encoding   not UTF-8, perhaps {}\n", format.encoding);
    if (!format.missing.empty()) text += fmt::format("missing    {}\n", fmt::join(format.missing, "  "));
  }
  text += fmt::format("rows       {}, lines {} .. {}\n", look.row_count, look.first_line, look.last_line);
  std::size_t width = 0;
  for (const LookedColumn& column : look.columns) width = std::max(width, column.name.size());
  width = std::min<std::size_t>(width, 30);
  for (std::size_t i = 0; i < look.columns.size(); ++i) {
    const bool is_clock = look.clock && look.clock->column == i;
    text += fmt::format("column {:>3} {:<{}}  {}{}\n", i + 1, format.has_header ? look.columns[i].name : "", width,
                        describe(look.columns[i]), is_clock ? dateText(look.columns[i], *look.clock) + "; " + describe(*look.clock) : "");
  }
  if (!look.clock) text += "clock      none recognised\n";
  return text;
}

std::string mappingText(const TableLook& look) {
  std::string text = fmt::format(
      "# Mapping of {}, begun by musclesim import --look. What follows is what can be seen of the file;\n"
      "# what the columns mean, only you know: complete and correct it.\n",
      inQuotes(std::filesystem::path(look.file).filename().string()));
  text += "robot = \"rig\"                        # rig, elbow, arm, wrist, pulley_arm, spring_bench, or a robot file\n";
  text += "pressure_full_scale_kPa = 600        # the pressure that counts as 1\n";
  if (std::ranges::any_of(look.columns, [](const LookedColumn& column) { return column.unit == "V"; }))
    text += "command_full_scale_V = 10            # the voltage that counts as 1\n";
  if (!isMatlabFile(look.file)) text += formatMembers(look.format);
  text += "\n[columns]                            # column of the recording = column of the table\n" + clockLine(look) + "\n";
  Suggestions suggestions;
  std::string columns;
  for (std::size_t i = 0; i < look.columns.size(); ++i) {
    if (look.clock && look.clock->column == i) continue;
    const LookedColumn& column = look.columns[i];
    const std::string from = reference(look, i);
    const std::string absolute = looksAbsolute(column) ? ", ambient_kPa = 101.325" : "";
    const bool is_plain = column.is_named && absolute.empty();
    columns += fmt::format("# {} = {}   # column {}: {}\n", suggestions.next(column),
                           is_plain ? from : "{ from = " + from + absolute + " }", i + 1, describe(column));
  }
  if (!suggestions.haveCommands())
    text += "# command_0_bar = \"...\"              # needed: one command for each muscle; { value = 3 } for a constant one\n";
  text += columns;
  text +=
      "\n# [rows]\n# step_s = 0.01                      # even rows: straight lines between readings, commands held\n"
      "# before_s = 1.0                     # before the first row the machine rested ...\n"
      "# before = { command_0_bar = 0 }     # ... under these commands\n";
  return text;
}

}  // namespace musclesim
