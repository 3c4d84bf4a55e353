#include "musclesim/robot/force_law.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

struct Row {
  double pressure_ratio, length_mm, tension_N, stiffness_N_per_mm;
};

/// Eq. 1 and its derivative for l_min = 120 mm, l_max = 300 mm, computed in decimal arithmetic with 40 digits.
constexpr Row table[] = {
    {0, 120, 0.007390503796, 0.00037789673279},
    {0, 165, 0.073786024944, 0.00377288186603},
    {0, 210, 0.736672035830, 0.03766806203897},
    {0, 255, 7.354857356621, 0.37607403257115},
    {0, 300, 73.430134585330, 3.75468421571575},
    {0.25, 120, 0.005542877847, 0.13380262115913},
    {0.25, 165, 6.063703456137, 0.13634886000906},
    {0.25, 210, 12.569231901731, 0.16177024513877},
    {0.25, 255, 23.541234829754, 0.41557472303790},
    {0.25, 300, 79.106056688714, 2.94953236039635},
    {0.5, 120, 0.003695251898, 0.26722734558547},
    {0.5, 165, 12.053620887330, 0.26892483815209},
    {0.5, 210, 24.401791767632, 0.28587242823856},
    {0.5, 255, 39.727612302886, 0.45507541350465},
    {0.5, 300, 84.781978792098, 2.14438050507695},
    {0.75, 120, 0.001847625949, 0.40065207001181},
    {0.75, 165, 18.043538318524, 0.40150081629512},
    {0.75, 210, 36.234351633533, 0.40997461133836},
    {0.75, 255, 55.913989776018, 0.49457610397140},
    {0.75, 300, 90.457900895483, 1.33922864975755},
    {1, 120, 0, 0.53407679443815},
    {1, 165, 24.033455749717, 0.53407679443815},
    {1, 210, 48.066911499434, 0.53407679443815},
    {1, 255, 72.100367249150, 0.53407679443815},
    {1, 300, 96.133822998867, 0.53407679443815},
};

TEST(BraunForceLaw, Equation1AgreesWithAHandComputedTable) {
  const BraunForceLaw law(120, 300);
  for (const Row& row : table)
    EXPECT_NEAR(law.tensionN(row.pressure_ratio, row.length_mm), row.tension_N, 1e-11) << row.pressure_ratio << ", " << row.length_mm;
}

TEST(BraunForceLaw, StiffnessAgreesWithAHandComputedTableAndWithTheDifferenceQuotient) {
  const BraunForceLaw law(120, 300);
  for (const Row& row : table) {
    EXPECT_NEAR(law.stiffnessNPerMm(row.pressure_ratio, row.length_mm), row.stiffness_N_per_mm, 1e-12);
    EXPECT_NEAR(law.ForceLaw::stiffnessNPerMm(row.pressure_ratio, row.length_mm), row.stiffness_N_per_mm, 1e-5);
  }
}

TEST(BraunForceLaw, PullsAsThePaperPrintsAtFullLength) {
  for (const double maximum_mm : {200.0, 300.0, 417.0}) {
    const BraunForceLaw law(105, maximum_mm);
    EXPECT_NEAR(law.tensionN(1, maximum_mm), 96.1, 0.05);
    EXPECT_NEAR(law.tensionN(0, maximum_mm), 73.4, 0.05);
  }
}

TEST(BraunForceLaw, PressureCountsAsAShareOfItsMaximum) {
  BraunConstants bar;
  bar.pressure_maximum_ratio = 6;
  const BraunForceLaw law(120, 300, bar), reference(120, 300);
  EXPECT_DOUBLE_EQ(law.tensionN(3, 200), reference.tensionN(0.5, 200));
  EXPECT_DOUBLE_EQ(law.stiffnessNPerMm(3, 200), reference.stiffnessNPerMm(0.5, 200));
}

TEST(BraunForceLaw, ConstantsAreParameters) {
  Parameters parameters;
  parameters.set("force_law.c_kgf", 1.0, "test");
  const BraunForceLaw law(0, 100, BraunConstants(parameters));
  EXPECT_DOUBLE_EQ(law.tensionN(1, 100), 9.81);
  Parameters wrong;
  wrong.set("force_law.b", nan, "test");
  EXPECT_THROW(BraunConstants{wrong}, BadParameter);
}

TEST(BraunForceLaw, RefusesLengthsOutOfOrderOrNotFinite) {
  for (const auto& [low, high] : {std::pair{300.0, 120.0}, {120.0, 120.0}, {-1.0, 100.0}, {nan, 100.0}, {0.0, nan}, {0.0, inf}})
    EXPECT_THROW(BraunForceLaw(low, high), BadParameter) << low << ", " << high;
  const auto message = messageOf<BadParameter>([] { BraunForceLaw(300, 120); });
  EXPECT_TRUE(contains(message, "300, 120 mm"));
}

TEST(BraunForceLaw, RefusesConstantsThatAreNotFinite) {
  for (double BraunConstants::*constant :
       {&BraunConstants::a, &BraunConstants::b, &BraunConstants::c_kgf, &BraunConstants::pressure_maximum_ratio})
    for (const double wrong : {nan, inf}) {
      BraunConstants constants;
      constants.*constant = wrong;
      EXPECT_THROW(BraunForceLaw(120, 300, constants), BadParameter);
    }
  BraunConstants without_pressure;
  without_pressure.pressure_maximum_ratio = 0;
  EXPECT_THROW(BraunForceLaw(120, 300, without_pressure), BadParameter);
}

}  // namespace
}  // namespace musclesim
