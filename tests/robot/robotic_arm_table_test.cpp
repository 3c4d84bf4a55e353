#include "../../robot/robotic_arm_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace musclesim {
namespace {

using robotic_arm::Kind;
using robotic_arm::MuscleRow;
using robotic_arm::muscles;
using robotic_arm::OperationRow;
using robotic_arm::operations;
using robotic_arm::PrimitiveRow;
using robotic_arm::primitives;
using robotic_arm::Triple;

constexpr double link_minimum_mm = 15.0;
constexpr double bead_radius_mm = 7.5;

double distance(const Triple& a, const Triple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// (1 - t) a + t b
Triple blend(const Triple& a, const Triple& b, double t) {
  Triple c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = a[i] + t * (b[i] - a[i]);
  return c;
}

/// The point at t of the cubic Bezier curve, in Bernstein form.
Triple curvePoint(const MuscleRow& m, double t) {
  const double u = 1.0 - t;
  Triple p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] =
        u * u * u * m.start_mm[i] + 3 * u * u * t * m.start_control_mm[i] + 3 * u * t * t * m.end_control_mm[i] + t * t * t * m.end_mm[i];
  }
  return p;
}

long linkCount(const MuscleRow& m) {
  return std::max(2L, std::lround(m.minimum_length_mm / link_minimum_mm));
}

/// Ends of the links, in order: one point more than links.
std::vector<Triple> linkEnds(const MuscleRow& m) {
  const long n = linkCount(m);
  std::vector<Triple> points;
  for (long i = 0; i <= n; ++i) points.push_back(curvePoint(m, static_cast<double>(i) / static_cast<double>(n)));
  return points;
}

/// Centres of the beads: two per link, one bead radius from either end.
std::vector<Triple> beads(const MuscleRow& m) {
  const std::vector<Triple> ends = linkEnds(m);
  std::vector<Triple> centres;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double share = bead_radius_mm / distance(ends[i - 1], ends[i]);
    centres.push_back(blend(ends[i - 1], ends[i], share));
    centres.push_back(blend(ends[i], ends[i - 1], share));
  }
  return centres;
}

double chainLength(const MuscleRow& m) {
  const std::vector<Triple> ends = linkEnds(m);
  double length = 0.0;
  for (std::size_t i = 1; i < ends.size(); ++i) length += distance(ends[i - 1], ends[i]);
  return length;
}

/// Distance between the closest centres of beads of two muscles.
double gapOfCentres(const MuscleRow& a, const MuscleRow& b) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Triple& p : beads(a)) {
    for (const Triple& q : beads(b)) gap = std::min(gap, distance(p, q));
  }
  return gap;
}

bool isPrimitive(const char* name) {
  return std::ranges::any_of(primitives(), [&](const PrimitiveRow& row) { return row.name == std::string(name); });
}

TEST(RoboticArmTable, HasAllBonesOperationsAndMuscles) {
  EXPECT_EQ(primitives().size(), 33u);
  EXPECT_EQ(operations().size(), 52u);
  EXPECT_EQ(muscles().size(), 30u);
}

TEST(RoboticArmTable, NamesOfPrimitivesAreUnique) {
  std::set<std::string> names;
  for (const PrimitiveRow& row : primitives()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
}

TEST(RoboticArmTable, EveryNameIsAPrimitive) {
  for (const OperationRow& row : operations()) {
    EXPECT_TRUE(isPrimitive(row.primitive)) << row.primitive;
    EXPECT_TRUE(row.other == nullptr || isPrimitive(row.other)) << row.other;
    for (const char* part : row.partNames()) EXPECT_TRUE(isPrimitive(part)) << part;
  }
  for (const MuscleRow& row : muscles()) {
    EXPECT_TRUE(isPrimitive(row.connect_start_to)) << row.connect_start_to;
    EXPECT_TRUE(isPrimitive(row.connect_end_to)) << row.connect_end_to;
  }
}

TEST(RoboticArmTable, OperationsCarryWhatTheirKindNeeds) {
  for (const OperationRow& row : operations()) {
    SCOPED_TRACE(row.primitive);
    const bool has_axis = row.kind == Kind::rotate || row.kind == Kind::hinge;
    EXPECT_EQ(std::string("xyz").find(row.axis) != std::string::npos, has_axis);
    EXPECT_EQ(row.partNames().size() > 1, row.kind == Kind::composite);
    EXPECT_EQ(row.angle_deg != 0.0, row.kind == Kind::rotate);
    EXPECT_EQ(row.low_deg < row.high_deg, row.kind == Kind::hinge);
  }
}

TEST(RoboticArmTable, NoPrimitiveIsPartOfTwoComposites) {
  std::set<std::string> used;
  for (const OperationRow& row : operations()) {
    for (const char* part : row.partNames()) EXPECT_TRUE(used.insert(part).second) << part;
  }
}

TEST(RoboticArmTable, LengthsAtTheStartLieWithinTheRange) {
  for (const MuscleRow& row : muscles()) {
    const double length = chainLength(row);
    EXPECT_GT(length, row.minimum_length_mm) << row.color_name;
    EXPECT_LT(length, row.maximum_length_mm) << row.color_name;
    const double shortest = static_cast<double>(linkCount(row)) * link_minimum_mm;
    const double ratio = (length - shortest) / (row.maximum_length_mm - shortest);
    EXPECT_GT(ratio, 0.35) << row.color_name;
    EXPECT_LT(ratio, 0.8) << row.color_name;
  }
}

TEST(RoboticArmTable, NoLinkIsShorterThanItsBeads) {
  for (const MuscleRow& row : muscles()) {
    const std::vector<Triple> ends = linkEnds(row);
    for (std::size_t i = 1; i < ends.size(); ++i)
      EXPECT_GE(distance(ends[i - 1], ends[i]), link_minimum_mm) << row.color_name << " link " << i;
  }
}

/// In muscles 2 and 5 of the published program the longest link starts beyond its stop; in the added muscles no link does.
TEST(RoboticArmTable, LinksOfFurtherMusclesStartWithinTheirStops) {
  for (const MuscleRow& row : muscles().subspan(10)) {
    const std::vector<Triple> ends = linkEnds(row);
    const double longest = row.maximum_length_mm / static_cast<double>(linkCount(row));
    for (std::size_t i = 1; i < ends.size(); ++i) EXPECT_LE(distance(ends[i - 1], ends[i]), longest) << row.color_name << " link " << i;
  }
}

TEST(RoboticArmTable, NoBeadsOfTwoMusclesTouch) {
  int pairs = 0;
  for (std::size_t i = 0; i < muscles().size(); ++i) {
    for (std::size_t j = i + 1; j < muscles().size(); ++j, ++pairs) {
      EXPECT_GE(gapOfCentres(muscles()[i], muscles()[j]), 2 * bead_radius_mm + 2.0) << "muscles " << i << " and " << j;
    }
  }
  EXPECT_EQ(pairs, 435);
}

TEST(RoboticArmTable, FurtherMusclesSpanTheJointsOfTheFirstTen) {
  auto bone = [](const char* name) {
    const std::string s = name;
    if (s.starts_with("rib")) return std::string("rib");
    return s == "elbow" ? std::string("humerus") : s;  // parts of one body
  };
  for (std::size_t i = 10; i < muscles().size(); ++i) {
    EXPECT_EQ(bone(muscles()[i].connect_start_to), bone(muscles()[i % 10].connect_start_to)) << i;
    EXPECT_EQ(bone(muscles()[i].connect_end_to), bone(muscles()[i % 10].connect_end_to)) << i;
  }
}

TEST(RoboticArmTable, ColorsAreUnique) {
  std::set<std::string> names;
  std::set<Triple> colors;
  for (const MuscleRow& row : muscles()) {
    EXPECT_TRUE(names.insert(row.color_name).second) << row.color_name;
    EXPECT_TRUE(colors.insert(row.cap_rgb).second) << row.color_name;
    for (const double part : row.cap_rgb) EXPECT_TRUE(part >= 0.0 && part <= 1.0) << row.color_name;
  }
}

}  // namespace
}  // namespace musclesim
