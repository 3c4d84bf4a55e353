#include "fit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "law_families.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

/// A relative squared error with three digits, or a dash if it is not defined.
std::string share(const FitError& error) {
  return error.isDefined() ? fmt::format("{:.2e}", error.relativeSquaredError()) : "-";
}

nlohmann::json shareJson(const FitError& error) {
  if (!error.isDefined()) return nullptr;
  return error.relativeSquaredError();
}

/// The cross-validated relative squared error.
double errorOf(const LawReport& report) {
  return report.validation.both().relativeSquaredError();
}

std::string pressureText(const StaticPoints& points) {
  return points.full_scale_kPa ? fmt::format("pressure 1 is {:g} kPa", *points.full_scale_kPa)
                               : std::string("pressures are fractions, as in the file");
}

}  // namespace

std::vector<LawReport> fitLaws(const std::vector<std::string>& names, const StaticPoints& points, const Specimen& specimen,
                               const BraunLengths& lengths) {
  std::vector<LawReport> reports;
  for (const auto& name : names) {
    LawReport report;
    report.model = makeLawModel(name, specimen, lengths);
    try {
      report.fit = fitLaw(*report.model, points);
      report.validation = crossValidate(*report.model, points, report.fit);
    } catch (const Error& error) {
      report.failure = error.what();
    }
    reports.push_back(std::move(report));
  }
  if (std::all_of(reports.begin(), reports.end(), [](const auto& report) { return !report.failure.empty(); }))
    throw BadFile(points.file, "no law could be fitted: " + reports.front().failure);
  return reports;
}

std::string errorTable(const std::vector<LawReport>& reports) {
  std::string out =
      "| law | constants | in-sample | cross-validated | inner lengths | inner pressures | outer lengths | outer pressures | largest error "
      "N |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& report : reports) {
    if (!report.failure.empty()) {
      out += fmt::format("| {} | {} | not fitted | | | | | | |\n", report.model->name(), report.model->parameters().size());
      continue;
    }
    const auto& v = report.validation;
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {:.1f} |\n", report.model->name(), report.model->parameters().size(),
                       share(report.fit.error), share(v.both()), share(v.lengths), share(v.pressures), share(v.outer_lengths),
                       share(v.outer_pressures), report.fit.error.largest_N);
  }
  return out;
}

std::string constantsText(const LawReport& report) {
  if (!report.failure.empty()) return fmt::format("{}: {}\n", report.model->name(), report.failure);
  if (report.model->isTable())
    return fmt::format("{}: {} forces at nodes, listed in the configuration file\n", report.model->name(), report.fit.constants.size());
  std::string out = fmt::format("{}:\n", report.model->name());
  for (const auto& constant : report.fit.constants)
    out += fmt::format(
        "  {:<6} {:>12.6g} {:<4} {}\n", constant.name, constant.value, constant.unit,
        constant.low ? fmt::format("95 %: {:.6g} .. {:.6g}", *constant.low, *constant.high) : std::string("not determined by the points"));
  for (const auto& warning : report.fit.warnings) out += "  warning: " + warning + "\n";
  for (const auto& note : report.validation.notes) out += "  note: " + note + "\n";
  return out;
}

const LawReport* lawToTake(const std::vector<LawReport>& reports) {
  constexpr double about_equal = 1.2, handicap_of_tables = 2;
  const auto cost = [&](const LawReport& report) { return errorOf(report) * (report.model->isTable() ? handicap_of_tables : 1); };
  std::vector<const LawReport*> validated;
  for (const LawReport& report : reports)
    if (report.failure.empty() && report.validation.both().isDefined()) validated.push_back(&report);
  if (validated.empty()) return nullptr;
  const double best = cost(**std::ranges::min_element(validated, {}, [&](const LawReport* report) { return cost(*report); }));
  std::erase_if(validated, [&](const LawReport* report) { return cost(*report) > about_equal * best; });
  return *std::ranges::min_element(validated, {}, [](const LawReport* report) { return report->model->parameters().size(); });
}

std::string adviceText(const std::vector<LawReport>& reports) {
  const LawReport* taken = lawToTake(reports);
  if (!taken) return "take   none: too few points to cross-validate a law; measure more pressures and lengths\n";
  std::string others;
  bool is_best = true;
  for (const LawReport& report : reports) {
    if (&report == taken || !report.failure.empty() || !report.validation.both().isDefined()) continue;
    is_best = is_best && errorOf(*taken) <= errorOf(report);
    others += fmt::format("{}{} {:.2e}", others.empty() ? "; others: " : ", ", report.model->name(), errorOf(report));
  }
  const std::string why =
      is_best ? "predicts best what it was not fitted to" : "predicts what it was not fitted to about as well as the best, simpler";
  return fmt::format("take   {}: {} (error {:.2e}, {} constants{})\n", taken->model->name(), why, errorOf(*taken),
                     taken->model->parameters().size(), others);
}

nlohmann::json toJson(const LawReport& report) {
  nlohmann::json json;
  if (!report.failure.empty()) {
    json["failure"] = report.failure;
    return json;
  }
  const auto& v = report.validation;
  json["relative_squared_error"] = shareJson(report.fit.error);
  json["relative_squared_error_cross_validated"] = shareJson(v.both());
  json["cross_validation"] = {{"inner_lengths", shareJson(v.lengths)},       {"inner_pressures", shareJson(v.pressures)},
                              {"outer_lengths", shareJson(v.outer_lengths)}, {"outer_pressures", shareJson(v.outer_pressures)},
                              {"inner_length_count", v.length_count},        {"inner_pressure_count", v.pressure_count}};
  json["maximum_error_N"] = report.fit.error.largest_N;
  json["maximum_error_line"] = report.fit.error.largest_line;
  for (const auto& constant : report.fit.constants) {
    auto& entry = json["constants"][constant.name];
    entry = {{"value", constant.value}, {"unit", constant.unit}};
    if (!report.model->isTable())
      entry["interval_95"] = constant.low ? nlohmann::json({*constant.low, *constant.high}) : nlohmann::json(nullptr);
  }
  json["warnings"] = report.fit.warnings;
  json["notes"] = report.validation.notes;
  return json;
}

std::string configurationToml(const LawReport& report, const StaticPoints& points) {
  const std::string name = report.model->name();
  // A file name may contain line ends, which would end the comment.
  std::string file = std::filesystem::path(points.file).filename().string();
  std::replace_if(
      file.begin(), file.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  std::string out = fmt::format("# The muscle of {}, by musclesim fit: law {}, relative squared error {:.3g} over {} points.\n", file, name,
                                report.fit.error.relativeSquaredError(), report.fit.error.count);
  out +=
      fmt::format("# {}. A robot's muscle at its maximum length corresponds to the measured one at {:g} mm, shorter ones in proportion;\n",
                  pressureText(points), report.model->restLengthMm(report.fit.parameters));
  out += "# rest_length_mm = 250 would make it correspond at 250 mm instead.\n[force_law]\n";
  out += fmt::format("name = \"{}\"\n", name.starts_with("chou-hannaford") ? "chou-hannaford" : name);
  for (const auto& [key, value] : report.model->configuration(report.fit.parameters)) out += fmt::format("{} = {}\n", key, value);
  return out;
}

}  // namespace musclesim
