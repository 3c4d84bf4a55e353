/// Fits to measured muscles; skipped if the measurements are not available.
#include <gtest/gtest.h>

#include <cmath>
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

TEST(MeasuredMuscles, LongMcKibbenMusclesInATensileTester) {
  const auto folder = sharedFolder() / "data" / "real" / "quadsegrity";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs the measurements " << folder;
  const Measured big(folder / "big_static.csv", {}), thin(folder / "small_static.csv", {});
  EXPECT_EQ(big.points.points.size(), 160U);
  EXPECT_EQ(thin.points.points.size(), 160U);
  for (const char* name : {"braun", "chou-hannaford", "sarosi"}) {
    const LawFit of_big = fitLaw(*big.model(name), big.points), of_thin = fitLaw(*thin.model(name), thin.points);
    EXPECT_LT(of_big.error.relativeSquaredError(), 1e-3) << name;
    EXPECT_LT(of_thin.error.relativeSquaredError(), 1.2e-2) << name;
    EXPECT_LT(std::abs(of_thin.error.largest_N), 2.5) << name;
  }
}

/// Weights hung from a vented and from a filled muscle: without the vented points few are left for the fold that leaves them out.
TEST(MeasuredMuscles, WeightsAtTwoPressuresAreFittedByAllLaws) {
  const auto data = sharedFolder() / "data";
  for (const auto& [file, count] :
       {std::pair{data / "real" / "cavatappi" / "static.csv", 26U}, {data / "field" / "12" / "weights.csv", 18U}}) {
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs the measurements " << file;
    const Measured weights(file, {});
    EXPECT_EQ(weights.points.points.size(), count);
    for (const char* name : {"braun", "chou-hannaford-linear", "chou-hannaford", "sarosi"})
      EXPECT_LT(weights.inSample(name), 1.1e-2) << name << " " << file;
  }
}

/// The points of case 15 of the field: a muscle with a threshold.
TEST(MeasuredMuscles, ALawThatPushesIsSaid) {
  StaticPoints points;
  points.file = "points.csv";
  points.full_scale_kPa = 600;
  for (int pressure_kPa = 300; pressure_kPa <= 600; pressure_kPa += 100)
    for (int length_mm = 200; length_mm <= 270; length_mm += 10) {
      const double force_N = pressure_kPa / 600.0 * (800 * std::pow(length_mm / 270.0, 2) - 360) - 30;
      StaticPoint point;
      point.pressure_ratio = pressure_kPa / 600.0;
      point.length_mm = length_mm;
      point.force_N = force_N;
      if (force_N > 0) points.points.push_back(point);
    }
  const Specimen specimen = specimenOf(points, std::nullopt);
  const LawFit fit = fitLaw(*makeLawModel("braun", specimen, {std::nullopt, specimen.rest_length_mm}), points);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_TRUE(contains(fit.warnings.back(), "braun pushes with up to 30 N when vented"));
}

}  // namespace
}  // namespace musclesim
