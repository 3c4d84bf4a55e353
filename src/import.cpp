/// `musclesim import`: turns a measured table into a recording.
#include "musclesim/log/import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "diagnosis/data/data_checks.h"
#include "log/table_look.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/replay.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace {

struct ImportArguments {
  std::string table, mapping, out;
  std::optional<std::string> look, mapping_out;
  bool quiet = false, overwrite = false;
};

/// A recording of a machine may be the only one.
void requireNew(const std::string& csv) {
  for (const std::string& file : {csv, sidecarPath(csv)})
    if (std::filesystem::exists(file)) throw BadParameter(fmt::format("{} exists: choose another name, or --overwrite it", file));
}

/// Shows how a table is written, and begins a mapping.
int lookCommand(const ImportArguments& arguments) {
  if (!arguments.table.empty()) throw BadParameter("--look", *arguments.look, "be the only file; a mapping to begin is named by -o");
  const TableLook look = lookAtTable(*arguments.look);
  for (const auto& note : look.notes) tell(note);
  fmt::print("{}", printable(lookText(look)));
  if (!arguments.mapping_out) return done;
  if (std::filesystem::exists(*arguments.mapping_out))
    throw BadParameter("-o", *arguments.mapping_out, "be a new file: a mapping is never overwritten");
  replaceFile(*arguments.mapping_out, mappingText(look));
  fmt::print("mapping    {0}: complete it, then musclesim import {1} {0} OUT.csv\n", printable(*arguments.mapping_out),
             printable(*arguments.look));
  return done;
}

/// Tells the user what will keep the recording from being replayed or compared: a robot that is not there yet or that refuses the
/// parameters, and signals that it does not have.
void noteRobot(const Recording& recording, const std::string& mapping) {
  const std::string& robot = recording.info.robot;
  if (isRobotFile(robot) && !std::filesystem::exists(robot)) {
    tell(fmt::format("there is no robot file {}: write it before you replay the recording", robot));
  } else if (!isRobotFile(robot) && std::ranges::none_of(registeredRobots(), [&](const auto& one) { return one.first == robot; })) {
    tell(fmt::format("this program has no robot {}: only a program that registers it can replay the recording", robot));
  } else {
    try {
      Simulation simulation(simulationOptionsFor(recording.info, mapping, {}));
      const Robot& built = simulation.build(robot);
      simulation.parameters().requireAllKnown();
      for (const std::string& note : unknownSignalNotes(recording, built)) tell(note);
    } catch (const Error& problem) {
      tell(fmt::format("the recording cannot be replayed yet: {}", problem.what()));
    }
  }
}

int importCommand(const ImportArguments& arguments) {
  if (arguments.look) return lookCommand(arguments);
  if (arguments.out.empty())
    throw BadParameter("import needs three files: TABLE MAPPING.toml OUT.csv; or --look TABLE to see what it holds");
  const ImportMapping mapping = readImportMapping(arguments.mapping);
  std::vector<std::string> inputs = {arguments.table, arguments.mapping};
  for (const ImportColumn& column : mapping.columns)
    if (!column.table.empty()) inputs.push_back(tableFile(arguments.table, column));
  requireOther(arguments.out, inputs);
  requireOther(sidecarPath(arguments.out), inputs);
  if (!arguments.overwrite) requireNew(arguments.out);
  const Recording recording = importTable(arguments.table, mapping);
  if (!arguments.quiet) {
    for (const auto& note : recording.notes) tell(note);
    for (const Dropout& dropout : dropoutsOf(recording))
      tell(fmt::format("there are no rows between {:.3f} and {:.3f} s: a replay holds the command there",
                       recording.time_s[dropout.next_row - 1], recording.time_s[dropout.next_row]));
    noteRobot(recording, arguments.mapping);
  }
  prepareRecording(arguments.out);
  writeRecording(recording, arguments.out);
  std::vector<std::string> names;
  for (const Signal& signal : recording.signals) names.push_back(signal.name);
  fmt::print("{}: {} rows over {:.3g} s, robot {}: {}\n", printable(arguments.out), recording.time_s.size(),
             recording.time_s.back() - recording.time_s.front(), printable(recording.info.robot), fmt::join(names, ", "));
  return done;
}

}  // namespace

Action addImport(CLI::App& command) {
  auto arguments = std::make_shared<ImportArguments>();
  command.add_option("table", arguments->table, "Table of measurements: text with separators, or a MATLAB file");
  command.add_option("mapping", arguments->mapping,
                     "How the table is written and what its columns mean: MAPPING.toml; docs/reference/recording_format.md describes it");
  command.add_option("out", arguments->out, "Recording to write: OUT.csv, with OUT.json beside it");
  CLI::Option* look =
      command
          .add_option("--look", arguments->look,
                      "Only show what can be recognised of a table: separator, header, columns with ranges and units, clock")
          ->option_text("TABLE");
  command.add_option("-o", arguments->mapping_out, "With --look: a mapping to begin from, with comments")
      ->option_text("MAPPING.toml")
      ->needs(look);
  command.add_flag("--overwrite", arguments->overwrite, "Replace OUT.csv and OUT.json if they exist");
  command.add_flag("--quiet", arguments->quiet, "No messages on standard error except errors");
  return [arguments] { return importCommand(*arguments); };
}

}  // namespace musclesim::command_line
