/// `musclesim import`: turns a measured table into a recording.
#include "musclesim/log/import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "commands.h"
#include "musclesim/robot/robot.h"
#include "musclesim/robot/robot_registry.h"
#include "output_folder.h"

namespace musclesim::program {

namespace {

struct ImportArguments {
  std::string table, mapping, out;
  bool quiet = false;
};

int importCommand(const ImportArguments& arguments) {
  const ImportMapping mapping = readImportMapping(arguments.mapping);
  std::vector<std::string> inputs = {arguments.table, arguments.mapping};
  for (const ImportColumn& column : mapping.columns)
    if (!column.table.empty()) inputs.push_back(tableFile(arguments.table, column));
  requireOther(arguments.out, inputs);
  requireOther(sidecarPath(arguments.out), inputs);
  const Recording recording = importTable(arguments.table, mapping);
  if (!arguments.quiet)
    for (const auto& note : recording.notes) std::fprintf(stderr, "musclesim: %s\n", note.c_str());
  const auto robots = registeredRobots();
  if (!arguments.quiet &&
      std::none_of(robots.begin(), robots.end(), [&](const auto& robot) { return robot.first == recording.info.robot; }))
    std::fprintf(stderr, "musclesim: this program has no robot %s: only a program that registers it can replay the recording\n",
                 recording.info.robot.c_str());
  prepareRecording(arguments.out);
  writeRecording(recording, arguments.out);
  std::vector<std::string> names;
  for (const Signal& signal : recording.signals) names.push_back(signal.name);
  fmt::print("{}: {} rows over {:.3g} s, robot {}: {}\n", arguments.out, recording.time_s.size(),
             recording.time_s.back() - recording.time_s.front(), recording.info.robot, fmt::join(names, ", "));
  return done;
}

}  // namespace

Action addImport(CLI::App& command) {
  auto arguments = std::make_shared<ImportArguments>();
  command.add_option("table", arguments->table, "Table of measurements: DATA.csv, one header row")->required();
  command
      .add_option("mapping", arguments->mapping,
                  "Meaning of its columns: MAPPING.toml; docs/reference/recording_format.md describes the format")
      ->required();
  command.add_option("out", arguments->out, "Recording to write: OUT.csv, with OUT.json beside it")->required();
  command.add_flag("--quiet", arguments->quiet, "No messages on standard error except errors");
  return [arguments] { return importCommand(*arguments); };
}

}  // namespace musclesim::program
