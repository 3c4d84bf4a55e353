// Readings at stops, of an elbow whose joint has stops at -70 and 70 degrees.
#include "diagnosis/model/stop_contacts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

struct Elbow {
  Simulation simulation;
  Elbow() { simulation.build("elbow"); }
  const Robot& robot() const { return const_cast<Simulation&>(simulation).robot(); }
};

/// Rows 0.1 s apart; the angles are given, pressure and length are 1 everywhere.
Recording withAngles(const std::vector<double>& angles_deg) {
  Recording recording;
  recording.file = "steps.csv";
  for (std::size_t row = 0; row < angles_deg.size(); ++row) recording.time_s.push_back(0.1 * static_cast<double>(row));
  const std::vector<double> ones(angles_deg.size(), 1.0);
  recording.signals = {{"command_0", ones}, {"pressure_0", ones}, {"length_0_mm", ones}, {"angle_elbow_deg", angles_deg}};
  return recording;
}

std::vector<double> between(std::size_t count) {
  return std::vector<double>(count, 20.0);
}

TEST(StopContacts, MotionIsLeftOutFromAContactToASecondAfterIt) {
  const Elbow elbow;
  std::vector<double> angles = between(60);
  angles[10] = angles[11] = 69.6;
  std::vector<Recording> recordings = {withAngles(angles)};
  const std::vector<std::string> notes = dropAfterStops(recordings, elbow.robot());
  ASSERT_EQ(notes.size(), 1u);
  for (const char* words : {"steps.csv: elbow is at its stop of 70 deg, first at 1.00 s", "(12 of 60 rows)"})
    EXPECT_TRUE(contains(notes[0], words)) << notes[0];
  for (const char* name : {"length_0_mm", "angle_elbow_deg"}) {
    const std::vector<double>& values = recordings[0].find(name)->values;
    EXPECT_TRUE(std::isfinite(values[9])) << name;
    for (std::size_t row = 10; row <= 21; ++row) EXPECT_TRUE(std::isnan(values[row])) << name << row;
    EXPECT_TRUE(std::isfinite(values[22])) << name;
  }
  for (const char* name : {"command_0", "pressure_0"})
    for (const double value : recordings[0].find(name)->values) EXPECT_EQ(value, 1) << name;
}

TEST(StopContacts, WithoutAnyNothingIsLeftOut) {
  const Elbow elbow;
  std::vector<Recording> recordings = {withAngles(between(40))};
  EXPECT_TRUE(dropAfterStops(recordings, elbow.robot()).empty());
  EXPECT_EQ(recordings[0].find("angle_elbow_deg")->values, between(40));
}

/// The machine's stop is elsewhere, which a diagnosis should find.
TEST(StopContacts, WhereAJointGoesBeyondItsStopEverythingStays) {
  const Elbow elbow;
  std::vector<double> angles = between(60);
  angles[10] = 69.8;
  angles[30] = 74;
  std::vector<Recording> recordings = {withAngles(angles)};
  EXPECT_TRUE(dropAfterStops(recordings, elbow.robot()).empty());
  EXPECT_EQ(recordings[0].find("angle_elbow_deg")->values, angles);
}

TEST(StopContacts, WhereMostRowsAreAtStopsEverythingStaysAndANoteSaysSo) {
  const Elbow elbow;
  std::vector<double> angles = between(20);
  for (std::size_t row = 0; row < angles.size(); row += 10) angles[row] = -70;
  std::vector<Recording> recordings = {withAngles(angles)};
  const std::vector<std::string> notes = dropAfterStops(recordings, elbow.robot());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(contains(notes[0], "nothing is left out")) << notes[0];
  EXPECT_EQ(recordings[0].find("angle_elbow_deg")->values, angles);
}

}  // namespace
}  // namespace musclesim
