/// Reports of a fit: tables, JSON, and a configuration file that gives any robot the fitted muscle.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cross_validation.h"

namespace musclesim {

/// One law fitted to one muscle, or the reason why it could not be fitted.
struct LawReport {
  std::shared_ptr<const LawModel> model;
  LawFit fit;
  CrossValidation validation;
  std::string failure;  ///< empty if fitted
  std::unique_ptr<ForceLaw> law() const { return model->build(fit.parameters); }
};

/// Fits and validates each of the named laws. A law with too many constants for the points gets a `failure`; throws BadFile if all do.
std::vector<LawReport> fitLaws(const std::vector<std::string>& names, const StaticPoints& points, const Specimen& specimen,
                               const BraunLengths& lengths);

/// One line per law, as Markdown: constants, relative squared errors in-sample and cross-validated, largest error.
std::string errorTable(const std::vector<LawReport>& reports);
/// One line per constant with its 95 % interval, then the warnings. A map gets one line instead, since its constants are forces at nodes.
std::string constantsText(const LawReport& report);
/// The law with the smallest cross-validated error, or one with fewer constants that is at most a fifth worse; null if none is validated.
/// A table must halve the error of the formulas, since it knows nothing beyond the measured points.
const LawReport* lawToTake(const std::vector<LawReport>& reports);
/// One line that says which law to take and why.
std::string adviceText(const std::vector<LawReport>& reports);
nlohmann::json toJson(const LawReport& report);
/// A TOML file that --config accepts.
std::string configurationToml(const LawReport& report, const StaticPoints& points);

}  // namespace musclesim
