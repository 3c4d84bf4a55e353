/// Fits to measured muscles; skipped if the measurements are not available.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "laboratory/fit_report.h"
#include "laboratory/law_families.h"
#include "laboratory/point_reader.h"
#include "support/support.h"

namespace musclesim {
namespace {

struct Measured {
  StaticPoints points;
  Specimen specimen;

  Measured(const std::filesystem::path& file, const StaticPointsOptions& options)
      : points(readStaticPoints(file.string(), options)), specimen(specimenOf(points, std::nullopt)) {
    markOutliers(points, specimen);
  }
  std::shared_ptr<LawModel> model(const std::string& name) const {
    return makeLawModel(name, specimen, {std::nullopt, specimen.rest_length_mm});
  }
  double inSample(const std::string& name) const { return fitLaw(*model(name), points).error.relativeSquaredError(); }
};

TEST(MeasuredMuscles, FestoMap) {
  const auto file = sharedFolder() / "data" / "real" / "martens-dmsp-static" / "dmsp20_300.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs the measurements " << file;
  const Measured festo(file, {});
  EXPECT_LE(festo.inSample("braun"), 1.4e-2);
  EXPECT_LE(festo.inSample("chou-hannaford-linear"), 0.9e-2);
  for (const char* name : {"chou-hannaford", "sarosi", "map"}) {
    const auto model = festo.model(name);
    const CrossValidation validation = crossValidate(*model, festo.points, fitLaw(*model, festo.points));
    EXPECT_LE(validation.both().relativeSquaredError(), 0.5e-2) << name;
    EXPECT_EQ(validation.length_count, 4) << "of six; the shortest is slack at all pressures";
  }
}

TEST(MeasuredMuscles, BraidedMusclesOfSixLengths) {
  const auto file = sharedFolder() / "data" / "real" / "psu-bpa10-isometric" / "static_points.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs the measurements " << file;
  for (const char* cut_cm : {"10", "15", "20", "25", "30", "40"}) {
    StaticPointsOptions options;
    options.columns = {{"length", "l_cm"}};
    options.where = {{"cut_length_cm", cut_cm}};
    options.censored_below_N = 0;
    const Measured muscle(file, options);
    EXPECT_LE(muscle.inSample("braun"), 3.8e-2) << cut_cm;
    EXPECT_LE(muscle.inSample("chou-hannaford"), 0.3e-2) << cut_cm;
    EXPECT_LE(muscle.inSample("sarosi"), 0.15e-2) << cut_cm;
  }
}

}  // namespace
}  // namespace musclesim
