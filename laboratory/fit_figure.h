/// The figure of a fit.
#pragma once

#include <string>

#include "fit_report.h"

namespace musclesim {

/// Left, force over length for up to ten pressures: the fitted law as curves, the points as discs (censored ones as rings, outliers as
/// crosses). Right, model minus measurement at the same lengths. SVG.
std::string fitFigureSvg(const LawReport& report, const StaticPoints& points);

}  // namespace musclesim
