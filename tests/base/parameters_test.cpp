#include "musclesim/base/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

double beadMass(Parameters& parameters) {
  return parameters.number("muscle.bead_mass_g", 10, "g", 0.01, 1e4, "mass of one bead");
}

TEST(Parameters, DefaultAndOverride) {
  Parameters parameters;
  EXPECT_EQ(beadMass(parameters), 10);
  Parameters changed;
  changed.setFromText("muscle.bead_mass_g=12.5", "--set");
  EXPECT_EQ(beadMass(changed), 12.5);
  EXPECT_EQ(beadMass(changed), 12.5) << "declaring twice is allowed";
  EXPECT_EQ(changed.declared().size(), 1u);
}

TEST(Parameters, OutOfRangeNamesValueUnitAndRange) {
  Parameters parameters;
  parameters.setFromText("muscle.bead_mass_g=-3", "--set");
  EXPECT_EQ(messageOf<BadParameter>([&] { beadMass(parameters); }),
            "--set: muscle.bead_mass_g = -3 g: must be a number in 0.01 .. 10000 g");
}

TEST(Parameters, RefusesTextNanAndInfinityForANumber) {
  for (const char* value : {"abc", "nan", "inf", "-inf", "", "1e999", "10g"}) {
    Parameters parameters;
    parameters.setFromText(std::string("muscle.bead_mass_g=") + value, "--set");
    EXPECT_THROW(beadMass(parameters), BadParameter) << value;
  }
}

TEST(Parameters, UnknownNameSuggestsTheNearest) {
  Parameters parameters;
  beadMass(parameters);
  parameters.setFromText("muscle.bead_mas_g=3", "--set");
  const auto message = messageOf<BadParameter>([&] { parameters.requireAllKnown(); });
  EXPECT_NE(message.find("did you mean \"muscle.bead_mass_g\"?"), std::string::npos) << message;
}

TEST(Parameters, OnlyNumbersThatAreNotZeroHaveATolerance) {
  Parameters parameters;
  beadMass(parameters);
  parameters.number("muscle.play_mm", 0, "mm", 0, 1, "no play");
  parameters.integer("muscle.count", 2, 1, 3, "whole number");
  parameters.choice("muscle.model", "chain", {"chain", "line"}, "choice");
  EXPECT_NO_THROW(parameters.requireScalable("muscle.bead_mass_g"));
  const auto refusal = [&](const std::string& name) { return messageOf<BadParameter>([&] { parameters.requireScalable(name); }); };
  EXPECT_TRUE(contains(refusal("bead_mass_g"), "did you mean \"muscle.bead_mass_g\"?"));
  EXPECT_TRUE(contains(refusal("muscle.play_mm"), "muscle.play_mm = 0: must not be 0"));
  EXPECT_TRUE(contains(refusal("muscle.count"), "muscle.count = 2: must be a number"));
  EXPECT_TRUE(contains(refusal("muscle.model"), "muscle.model = chain: must be a number"));
}

TEST(Parameters, AssignmentNeedsAnEqualsSign) {
  Parameters parameters;
  EXPECT_THROW(parameters.setFromText("muscle.bead_mass_g", "--set"), BadParameter);
  EXPECT_THROW(parameters.setFromText("=3", "--set"), BadParameter);
}

TEST(Parameters, ChoiceAndInteger) {
  Parameters parameters;
  parameters.setFromText("physics.composite_inertia=sumed", "--set");
  EXPECT_THROW(parameters.choice("physics.composite_inertia", "exact", {"exact", "summed"}, ""), BadParameter);
  parameters.setFromText("asm.attractor_count=2.5", "--set");
  EXPECT_THROW(parameters.integer("asm.attractor_count", 400, 1, 100000, ""), BadParameter);
}

TEST(Parameters, TomlRoundTrip) {
  Parameters first;
  first.setFromText("muscle.bead_mass_g=0.1", "--set");
  beadMass(first);
  first.choice("physics.composite_inertia", "exact", {"exact", "summed"}, "how");
  const auto file = (std::filesystem::temp_directory_path() / "musclesim_parameters_test.toml").string();
  std::ofstream(file) << first.toToml();
  Parameters second;
  second.readToml(file);
  EXPECT_EQ(beadMass(second), 0.1);
  EXPECT_EQ(second.choice("physics.composite_inertia", "summed", {"exact", "summed"}, "how"), "exact");
  EXPECT_NO_THROW(second.requireAllKnown());
  std::filesystem::remove(file);
}

TEST(Parameters, BrokenTomlNamesLineAndColumn) {
  const auto file = (std::filesystem::temp_directory_path() / "musclesim_broken_test.toml").string();
  std::ofstream(file) << "[muscle]\nbead_mass_g = = 3\n";
  Parameters parameters;
  const auto message = messageOf<BadFile>([&] { parameters.readToml(file); });
  EXPECT_NE(message.find(file + ":2:"), std::string::npos) << message;
  std::ofstream(file) << "[muscle]\nbead_mass_g = [1, 2]\n";
  EXPECT_THROW(parameters.readToml(file), BadFile);
  std::filesystem::remove(file);
  EXPECT_THROW(parameters.readToml(file), IoError);
}

TEST(Parameters, DropsUnknownOverridesOfFilesByGroup) {
  Parameters parameters;
  parameters.setFromFile("asm.noise_std", 0.1, "a.toml");
  parameters.setFromFile("rig.load_kg", 1.0, "a.toml");
  parameters.set("asm.width", 0.1, "--set");
  EXPECT_EQ(parameters.dropUnknownOfFiles({"asm"}), std::vector<std::string>{"asm.noise_std"});
  EXPECT_TRUE(parameters.dropUnknownOfFiles({"asm"}).empty());
  parameters.number("asm.width", 1, "", 0, 2, "");
  EXPECT_THROW(parameters.requireAllKnown(), BadFile) << "rig.load_kg belongs to no such group";
}

}  // namespace
}  // namespace musclesim
