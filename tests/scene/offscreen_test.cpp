#include "simulation/scene/offscreen.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "musclesim/controller/hold.h"
#include "simulation/scene/scene_error.h"
#include "src/view.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

Image readPng(const fs::path& file) {
  png_image description = {};
  description.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&description, file.c_str())) throw IoError(file.string() + ": " + description.message);
  description.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(description.width), static_cast<int>(description.height),
              std::vector<std::uint8_t>(PNG_IMAGE_SIZE(description))};
  png_image_finish_read(&description, nullptr, image.rgb.data(), 0, nullptr);
  return image;
}

constexpr int background = 230;

/// Share of pixels that differ by more than 24 of 255 in a colour, among the pixels that are not background in at least one picture.
/// Drivers draw edges differently, but not whole surfaces.
double differingShare(const Image& a, const Image& b) {
  constexpr int allowed = 24;
  if (a.width != b.width || a.height != b.height) return 1;
  long differing = 0, drawn = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool differs = false, is_drawn = false;
    for (std::size_t c = i; c < i + 3; ++c) {
      differs |= std::abs(a.rgb[c] - b.rgb[c]) > allowed;
      is_drawn |= std::abs(a.rgb[c] - background) > 1 || std::abs(b.rgb[c] - background) > 1;
    }
    differing += differs;
    drawn += is_drawn;
  }
  return drawn > 0 ? static_cast<double>(differing) / static_cast<double>(drawn) : 0;
}

/// Largest difference between drivers; a style changes at least twice as much.
constexpr double tolerance = 0.008;

/// A robot under constant pressures for a while, and its pictures. Skipped without OSMesa.
class Pictures : public testing::Test {
 protected:
  static constexpr int width_px = 400, height_px = 300;

  void SetUp() override {
    try {
      offscreen_ = std::make_unique<Offscreen>(width_px, height_px);
    } catch (const SceneError& error) {
      GTEST_SKIP() << error.what();
    }
  }

  Snapshot snapshotOf(const std::string& robot, bool plane = false) {
    SimulationOptions options;
    options.plane = plane;
    Simulation simulation(options);
    simulation.build(robot);
    const musclesim::Action action(static_cast<std::size_t>(simulation.robot().actuatorCount()), 0.3);
    simulation.start(simulation.robot().initialState(), action);
    for (int i = 0; i < 5; ++i) simulation.step();
    return SnapshotTaker(simulation).take(simulation.robot().getState());
  }

  Image draw(const std::string& robot, const Snapshot& snapshot, const SceneStyle& style = {}) {
    return offscreen_->draw(snapshot, command_line::initialCamera(robot, snapshot, {}), style);
  }

  /// Compares with tests/scene/pictures/NAME.png; with MUSCLESIM_STORE_PICTURES=1 it writes a new picture instead.
  void compareWithStored(const std::string& name, const Image& image) {
    const fs::path stored = fs::path(MUSCLESIM_STORED_PICTURES) / (name + ".png");
    if (std::getenv("MUSCLESIM_STORE_PICTURES")) writePng(image, stored.string());
    EXPECT_LT(differingShare(image, readPng(stored)), tolerance) << name;
  }

  /// Expects the stored picture, and one that differs enough from the picture without the style to detect a style without effect.
  void compareStyle(const std::string& name, const Snapshot& snapshot, const SceneStyle& style, const std::vector<SceneStyle>& without) {
    const Image image = draw("arm", snapshot, style);
    compareWithStored(name, image);
    for (const SceneStyle& other : without) EXPECT_GT(differingShare(image, draw("arm", snapshot, other)), 2 * tolerance) << name;
  }

  static long countPixels(const Image& image, int red, int green, int blue, int tolerance) {
    long count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      count += std::abs(image.rgb[i] - red) <= tolerance && std::abs(image.rgb[i + 1] - green) <= tolerance &&
               std::abs(image.rgb[i + 2] - blue) <= tolerance;
    return count;
  }

  std::unique_ptr<Offscreen> offscreen_;
};

TEST_F(Pictures, ArmRigAndElbowLookAsStored) {
  for (const std::string robot : {"arm", "rig", "elbow"}) compareWithStored(robot, draw(robot, snapshotOf(robot)));
  compareWithStored("arm_plane", draw("arm", snapshotOf("arm", true)));
}

TEST_F(Pictures, StylesLookAsStored) {
  const Snapshot snapshot = snapshotOf("arm");
  const SceneStyle plain;
  SceneStyle style;
  style.transparent = true;
  compareStyle("arm_transparent", snapshot, style, {plain});
  style = {};
  style.color_tension = true;
  compareStyle("arm_tension", snapshot, style, {plain});
  SceneStyle frames, selected;
  frames.frames = true;
  selected.selected = 3;
  style = frames;
  style.selected = selected.selected;
  compareStyle("arm_frames", snapshot, style, {frames, selected});
}

/// Pixels in which a colour stands out: red, green and blue are compared with their mean.
static long pixelsLike(const Image& image, const std::function<bool(int red, int green, int blue)>& is_like) {
  long count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) count += is_like(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
  return count;
}

TEST_F(Pictures, ArrowsLookAsStored) {
  SceneStyle arrows;
  arrows.arrows = true;
  Snapshot snapshot = snapshotOf("elbow");
  ASSERT_GT(snapshot.hoses[0].tension_N, 5);
  const Image plain = draw("elbow", snapshot), marked = draw("elbow", snapshot, arrows);
  compareWithStored("elbow_arrows", marked);
  EXPECT_GT(differingShare(plain, marked), 0.02);
  for (DrawnHose& hose : snapshot.hoses) hose.tension_N = 0;
  EXPECT_EQ(differingShare(draw("elbow", snapshot), draw("elbow", snapshot, arrows)), 0) << "without tension there is no arrow";
}

TEST_F(Pictures, ContactsAndPullsAreArrowsOfTheirOwnColours) {
  const auto is_orange = [](int red, int green, int blue) { return red > 150 && green > 60 && green < red - 40 && blue < 60; };
  const auto is_purple = [](int red, int green, int blue) { return red > 80 && blue > 80 && green < red / 2 && green < blue / 2; };
  SceneStyle arrows;
  arrows.arrows = true;
  Snapshot snapshot = snapshotOf("rig");
  const Image before = draw("rig", snapshot, arrows);
  snapshot.contacts.push_back({{80, -100, 0}, {1, 0, 0}});
  snapshot.pull = DrawnPull{{0, -150, 30}, {-80, -200, 30}, 20};
  const Image after = draw("rig", snapshot, arrows), without = draw("rig", snapshot);
  EXPECT_GT(pixelsLike(after, is_orange), pixelsLike(before, is_orange) + 20);
  EXPECT_GT(pixelsLike(after, is_purple), pixelsLike(before, is_purple) + 40);
  EXPECT_EQ(pixelsLike(without, is_orange), 0) << "contacts only with the arrows";
  EXPECT_GT(pixelsLike(without, is_purple), 40) << "a pull is always shown";
}

TEST_F(Pictures, SnapshotsHaveTheContacts) {
  Simulation simulation;
  simulation.build("arm");
  simulation.start("built", musclesim::Action(10, 0.3));
  for (int i = 0; i < 30; ++i) simulation.step();
  const Snapshot snapshot = SnapshotTaker(simulation).take(simulation.robot().getState());
  EXPECT_GT(snapshot.contacts.size(), 2u);
  EXPECT_EQ(snapshot.contacts.size(), static_cast<std::size_t>(simulation.contactCount()));
  const Bounds bounds = boundsOf(snapshot);
  for (const DrawnContact& contact : snapshot.contacts) {
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-5F);
    EXPECT_TRUE((contact.point_mm.array() >= bounds.low.array()).all() && (contact.point_mm.array() <= bounds.high.array()).all());
  }
}

TEST_F(Pictures, NothingIsClippedInTheFirstView) {
  for (const std::string robot : {"arm", "rig", "elbow"}) {
    const Image image = draw(robot, snapshotOf(robot));
    for (int x = 0; x < image.width; ++x)
      for (const int y : {0, image.height - 1})
        EXPECT_NEAR(image.rgb[static_cast<std::size_t>((y * image.width + x) * 3)], 230, 1) << robot << " at " << x << ", " << y;
    for (int y = 0; y < image.height; ++y)
      for (const int x : {0, image.width - 1})
        EXPECT_NEAR(image.rgb[static_cast<std::size_t>((y * image.width + x) * 3)], 230, 1) << robot << " at " << x << ", " << y;
  }
}

TEST_F(Pictures, SelectedMuscleIsRed) {
  const Snapshot snapshot = snapshotOf("elbow");
  const auto red = [](const Image& image) {
    long count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      count += image.rgb[i] > 80 && 4 * image.rgb[i + 1] < image.rgb[i] && 4 * image.rgb[i + 2] < image.rgb[i];
    return count;
  };
  SceneStyle style;
  EXPECT_EQ(red(draw("elbow", snapshot, style)), 0);
  style.selected = 1;
  EXPECT_GT(red(draw("elbow", snapshot, style)), 300);
}

TEST_F(Pictures, ColoursAreThePapers) {
  const Image image = draw("arm", snapshotOf("arm"));
  EXPECT_GT(countPixels(image, 230, 230, 230, 1), image.width * image.height / 2) << "background 0.9";
  EXPECT_GT(countPixels(image, 42, 42, 42, 14), 1000) << "hoses 0.2, lit";
  EXPECT_GT(countPixels(image, 170, 170, 170, 40), 4000) << "bones 0.8, lit";
}

TEST_F(Pictures, TensionColoursGoFromDarkToBright) {
  EXPECT_LT(tensionColor(0).green, tensionColor(50).green);
  EXPECT_LT(tensionColor(50).green, tensionColor(100).green);
  EXPECT_EQ(tensionColor(100).red, tensionColor(1e9).red);
  EXPECT_EQ(tensionColor(-5).red, tensionColor(0).red);
}

TEST_F(Pictures, LookingOnChangesNothing) {
  const auto hand = [](bool watched) {
    Simulation simulation;
    simulation.build("arm");
    simulation.start("built", musclesim::Action(10, 0.4));
    for (int i = 0; i < 20; ++i) {
      simulation.step();
      if (watched) SnapshotTaker(simulation).take(State{});
    }
    return simulation.robot().handMm();
  };
  EXPECT_EQ(hand(true), hand(false));
}

TEST(Offscreen, RefusesSizesThatCannotBe) {
  EXPECT_THROW(Offscreen(0, 100), BadParameter);
  EXPECT_THROW(Offscreen(100, 100000), BadParameter);
}

TEST(InitialCamera, RefusesNumbersThatCannotBe) {
  EXPECT_THROW(command_line::initialCamera("rig", Snapshot{}, {0, 95, 500}), BadParameter);
  EXPECT_THROW(command_line::initialCamera("rig", Snapshot{}, {0, 0, 0}), BadParameter);
  EXPECT_FLOAT_EQ(command_line::initialCamera("rig", Snapshot{}, {20, 30, 500}).elevation_deg, 30);
}

}  // namespace
}  // namespace musclesim
