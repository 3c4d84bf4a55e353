/// `musclesim experiment`: simulates the paper's load-frame experiment.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "laboratory/frame_report.h"
#include "laboratory/point_reader.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

struct ExperimentArguments {
  std::string specimen = "all";
  std::optional<std::string> data, out;
  PointsOptions points;
};

/// Reads "all", the name of a specimen, or MIN/MAX in mm.
std::vector<FrameSpecimen> specimensOf(const std::string& written) {
  if (written == "all") return frameSpecimens();
  for (const auto& specimen : frameSpecimens())
    if (specimen.name == written) return {specimen};
  FrameSpecimen specimen{"custom", 0, 0};
  const char* end = written.data() + written.size();
  const auto minimum = std::from_chars(written.data(), end, specimen.minimum_mm);
  if (minimum.ec == std::errc() && minimum.ptr != end && *minimum.ptr == '/') {
    const auto maximum = std::from_chars(minimum.ptr + 1, end, specimen.maximum_mm);
    if (maximum.ec == std::errc() && maximum.ptr == end && specimen.minimum_mm >= 15 && specimen.maximum_mm > specimen.minimum_mm)
      return {specimen};
  }
  throw BadParameter("specimen", written, "be all, short, medium, long, or MIN/MAX in mm, 15 <= MIN < MAX");
}

nlohmann::json errorsOf(const std::vector<FramePoint>& points) {
  const auto free = freePoints(points);
  return {{"relative_squared_error", frameError(free)},
          {"points", free.size()},
          {"loading", frameError(pointsOf(free, FrameWay::loading))},
          {"unloading", frameError(pointsOf(free, FrameWay::unloading))},
          {"points_at_stops", stoppedPoints(points).size()},
          {"relative_squared_error_at_stops", frameError(stoppedPoints(points))}};
}

int experiment(const ModelOptions& model, const ExperimentArguments& arguments) {
  endAtInterrupts();
  const auto specimens = specimensOf(arguments.specimen);
  std::optional<StaticPoints> measured;
  if (arguments.data) measured = readStaticPoints(*arguments.data, staticPointsOptions(arguments.points));
  if (measured)
    for (const auto& note : measured->notes) say(model, note);
  const Parameters parameters = parametersFrom(model);
  const fs::path folder = outputFolder(arguments.out, "experiment");
  if (arguments.data)
    for (const auto& specimen : specimens) requireOther(folder / (specimen.name + ".csv"), {*arguments.data});
  nlohmann::json json = {{"command", "experiment"}, {"status", "done"}, {"out", folder.string()}};
  std::vector<FrameReport> reports;
  for (const auto& specimen : specimens) {
    const auto law = frameLaw(specimen, parameters);
    say(model, fmt::format("{} muscle, {:g}/{:g} mm", specimen.name, specimen.minimum_mm, specimen.maximum_mm));
    const FrameReport report{specimen, loadSteps(specimen, parameters), lengthSteps(specimen, parameters)};
    replaceFile((folder / (specimen.name + ".csv")).string(), frameCsv(report));
    replaceFile((folder / (specimen.name + ".svg")).string(), frameFigureSvg(report, *law));
    auto& entry = json["specimens"][specimen.name];
    entry = {{"loads_hung", errorsOf(report.loads)}, {"lengths_imposed", errorsOf(report.lengths)}};
    if (measured) {
      const DataComparison comparison = compareWithData(report.lengths, *law, *measured);
      entry["data"] = {{"relative_squared_error", comparison.relative_squared_error},
                       {"points", comparison.compared_count},
                       {"outside", comparison.outside_count}};
    }
    reports.push_back(report);
  }
  fmt::print("{}\n", frameTable(reports));
  if (measured)
    for (const auto& [name, entry] : json["specimens"].items())
      fmt::print(
          "{} compared with {}: relative squared error {:.3g} over {} points; {} points lie outside the simulated pressures and lengths\n",
          name, *arguments.data, entry["data"]["relative_squared_error"].get<double>(), entry["data"]["points"].get<int>(),
          entry["data"]["outside"].get<int>());
  for (const auto& specimen : specimens) fmt::print("points  {0}.csv\nfigure  {0}.svg\n", (folder / specimen.name).string());
  if (model.json) fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return done;
}

}  // namespace

Action addExperiment(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<ExperimentArguments>();
  command.add_option("--specimen", arguments->specimen, "short (60/200 mm), medium (75/300), long (60/350), all, or MIN/MAX in mm")
      ->capture_default_str();
  CLI::Option* data = command.add_option("--data", arguments->data, "Measured static points to compare with, as for fit");
  addPointsOptions(command, *data, arguments->points);
  command.add_option("--out", arguments->out, "Folder for points and figures (default: log/runs/<date-time>-experiment)");
  command.add_option("--config", model.config, "TOML file with named parameters, for example a fitted muscle");
  command
      .add_option("--set", model.set,
                  "Override one named parameter; may be repeated. The experiment itself sets the loads and the specimen's lengths")
      ->allow_extra_args(false)
      ->option_text("NAME=VALUE");
  command.add_flag("--quiet", model.quiet, "No messages on standard error except errors");
  command.add_flag("--json", model.json, "Print the verdict as one JSON object, the last line of standard output");
  return [&model, arguments] { return experiment(model, *arguments); };
}

}  // namespace musclesim::command_line
