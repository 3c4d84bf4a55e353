/// `musclesim fit`: force laws from measured static points.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "laboratory/fit_figure.h"
#include "laboratory/fit_report.h"
#include "laboratory/law_families.h"
#include "laboratory/point_reader.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

struct FitArguments {
  std::string data, law = "all";
  PointsOptions points;
  std::optional<double> rest_length_mm;
  std::optional<std::string> out;
  std::string minimum_length = "free", maximum_length = "rest";
  bool quiet = false, json = false;
};

/// A fixed length of Eq. 1 in mm, or nothing if the length is to be fitted.
std::optional<double> lengthMm(const std::string& option, const std::string& written) {
  if (written == "free") return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(written.c_str(), &end);
  if (end != written.c_str() + written.size() || !(value > 0 && value < 1e4))
    throw BadParameter(option, written, "be free or a length in mm, 0 .. 10000");
  return value;
}

BraunLengths braunLengths(const FitArguments& arguments, const Specimen& specimen) {
  const bool given = arguments.minimum_length != FitArguments().minimum_length || arguments.maximum_length != FitArguments().maximum_length;
  if (given && arguments.law != "all" && arguments.law != "braun")
    throw BadParameter("--law", arguments.law,
                       "be braun or all where --minimum-length or --maximum-length is given: only Eq. 1 has these lengths");
  BraunLengths lengths;
  lengths.minimum_mm = lengthMm("--minimum-length", arguments.minimum_length);
  lengths.maximum_mm =
      arguments.maximum_length == "rest" ? specimen.rest_length_mm : lengthMm("--maximum-length", arguments.maximum_length);
  if (lengths.minimum_mm && lengths.maximum_mm && *lengths.minimum_mm >= *lengths.maximum_mm)
    throw BadParameter("--minimum-length", arguments.minimum_length, fmt::format("be below the maximum, {} mm", *lengths.maximum_mm));
  return lengths;
}

/// Writes configuration and figure of each fitted law; returns the configurations' paths by law.
std::map<std::string, std::string> writeFiles(const std::vector<LawReport>& reports, const StaticPoints& points, const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& report : reports) {
    if (!report.failure.empty()) continue;
    const std::string file = (folder / (report.model->name() + ".toml")).string();
    replaceFile(file, configurationToml(report, points));
    replaceFile((folder / (report.model->name() + ".svg")).string(), fitFigureSvg(report, points));
    files[report.model->name()] = file;
  }
  return files;
}

nlohmann::json verdictOf(const FitArguments& arguments, const StaticPoints& points, const std::vector<LawReport>& reports,
                         const std::map<std::string, std::string>& files, const fs::path& folder) {
  nlohmann::json json = {{"command", "fit"}, {"status", "done"}, {"data", arguments.data}, {"out", folder.string()}};
  json["points"] = points.points.size();
  json["censored_points"] = points.censoredCount();
  json["outlier_lines"] = nlohmann::json::array();
  for (const auto& point : points.points)
    if (point.outlier) json["outlier_lines"].push_back(point.line);
  if (points.full_scale_kPa) json["pressure_full_scale_kPa"] = *points.full_scale_kPa;
  const LawReport* taken = lawToTake(reports);
  json["take"] = taken ? nlohmann::json(taken->model->name()) : nlohmann::json();
  for (const auto& report : reports) {
    auto& law = json["laws"][report.model->name()];
    law = toJson(report);
    if (const auto file = files.find(report.model->name()); file != files.end()) {
      law["config"] = file->second;
      law["figure"] = fs::path(file->second).replace_extension(".svg").string();
    }
  }
  return json;
}

int fit(const FitArguments& arguments) {
  endAtInterrupts();
  StaticPoints points = readStaticPoints(arguments.data, staticPointsOptions(arguments.points));
  const Specimen specimen = specimenOf(points, arguments.rest_length_mm);
  const BraunLengths lengths = braunLengths(arguments, specimen);
  const std::vector<std::string> names = arguments.law == "all" ? lawModelNames() : std::vector{arguments.law};
  for (const auto& name : names) makeLawModel(name, specimen, lengths);
  markOutliers(points, specimen);
  if (!arguments.quiet)
    for (const auto& note : points.notes) tell(note);
  const auto reports = fitLaws(names, points, specimen, lengths);
  const fs::path folder = outputFolder(arguments.out, "fit-" + fs::path(arguments.data).stem().string());
  const auto files = writeFiles(reports, points, folder);
  fmt::print("{}\n", errorTable(reports));
  for (const auto& report : reports) fmt::print("{}", constantsText(report));
  fmt::print("{}", adviceText(reports));
  for (const auto& [name, file] : files) fmt::print("config  {}\nfigure  {}\n", file, fs::path(file).replace_extension(".svg").string());
  if (arguments.json)
    fmt::print("{}\n", verdictOf(arguments, points, reports, files, folder).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return done;
}

}  // namespace

Action addFit(CLI::App& command) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::Option* data = command
                          .add_option("data", arguments->data,
                                      "Table of static points: pressure or pressure_kPa|bar|MPa|psi ..., length_mm|cm|m ..., force_N ...")
                          ->required();
  command.add_option("--law", arguments->law, fmt::format("all, or one of {}", fmt::join(lawModelNames(), ", ")))->capture_default_str();
  addPointsOptions(command, *data, arguments->points);
  command
      .add_option("--rest-length", arguments->rest_length_mm, "Rest length of the measured muscle in mm (default: the longest measured)")
      ->check(CLI::Range(5.0, 1e4));
  command.add_option("--minimum-length", arguments->minimum_length, "l_min of Eq. 1 in mm, or free")->capture_default_str();
  command.add_option("--maximum-length", arguments->maximum_length, "l_max of Eq. 1 in mm, free, or rest: the rest length")
      ->capture_default_str();
  command.add_option("--out", arguments->out, "Folder for configuration files and figures (default: log/runs/<date-time>-fit-<data>)");
  command.add_flag("--quiet", arguments->quiet, "No messages on standard error except errors");
  command.add_flag("--json", arguments->json, "Print the verdict as one JSON object, the last line of standard output");
  return [arguments] { return fit(*arguments); };
}

}  // namespace musclesim::command_line
