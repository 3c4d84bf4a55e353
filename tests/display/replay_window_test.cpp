// A replay in the window: the ghost, the time line, effects on and off.
#include <numbers>
#include <set>

#include "src/program.h"
#include "window_fixture.h"

namespace musclesim {
namespace {

/// A replay of an elbow whose valves lag, with the lag as the effects of --effects.
class ReplayWindowTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    std::ofstream(folder_ / "lag.json") << R"({"format": "musclesim-effects-1", "effects": [{"id": "valve_lag", "component": "all",
              "parameters": {"fill_time_constant_s": 0.15, "vent_time_constant_s": 0.25}}]})";
    ASSERT_EQ(runProgram({"--simple", "--quiet", "--robot", "elbow", "--controller", "triangle", "--duration", "4", "--effects", "lag.json",
                          "--record", "elbow.csv", "--out", "record"},
                         folder_)
                  .status,
              0);
    json sidecar = json::parse(contentOf(folder_ / "elbow.json"));
    sidecar.erase("active_effects");  // a machine does not know its own lag
    std::ofstream(folder_ / "elbow.json") << sidecar.dump();
  }

  /// Where a point is in the pictures of the window.
  static Eigen::Vector2f pixelOf(const json& state, const Image& picture, const Eigen::Vector3f& point_mm) {
    return *cameraOf(state).pixelOf(point_mm, static_cast<float>(picture.width), static_cast<float>(picture.height));
  }

  enum class Seen { background, robot, ghost };
  static Seen seenAt(const Image& picture, const Eigen::Vector2f& at) {
    const std::size_t i = 3 * (static_cast<std::size_t>(std::lround(at.y())) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(std::lround(at.x())));
    const int red = picture.rgb[i], blue = picture.rgb[i + 2];
    if (blue > red + 40) return Seen::ghost;
    return std::abs(red - 230) <= 1 && std::abs(blue - 230) <= 1 ? Seen::background : Seen::robot;
  }

  double angleOf(const std::string& recording, std::size_t row) const {
    return readRecording((folder_ / recording).string()).find("angle_elbow_deg")->values[row];
  }

  /// The middle of the elbow's forearm at an angle.
  static Eigen::Vector3f forearmAt(double angle_deg) {
    const double rad = angle_deg * std::numbers::pi / 180;
    return Eigen::Vector3d(200 * std::sin(rad), -200 * std::cos(rad), 0).cast<float>();
  }
};

TEST_F(ReplayWindowTest, TheGhostIsWhereTheRecordingSaysAndTheEffectsCloseTheGap) {
  Session session(*server_, folder_,
                  {"replay", "elbow.csv", "--window", "--effects", "lag.json", "--out", "run/sim.csv", "--camera", "0,0,900",
                   "--picture-size", "950x480"});
  session.press("p");
  json state = session.press("e");
  EXPECT_EQ(state["replay"]["with_effects"], false);
  EXPECT_FALSE(state["replay"]["outside_s"].empty());
  const Image any = picture(session);

  // The time line runs 14 pixels from both edges of the scene, 19 pixels above its lower edge.
  const double at_s = 3.2;
  const auto x = std::lround(14 + at_s / 4 * (any.width - 28));
  const std::size_t lines = session.lineCount();
  session.xdotool("mousemove 60 461 mousedown 1 mousemove 90 461 mousemove " + std::to_string(x) + " 461 mouseup 1");
  state = session.stateAfter(lines + 1);
  EXPECT_EQ(state["event"], "scrub");
  EXPECT_NEAR(state["time_s"], at_s, 0.02);
  const std::size_t row = state["replay"]["row"];
  ASSERT_EQ(runProgram({"replay", "elbow.csv", "--out", "without.csv"}, folder_).status, 0);

  const Image without = picture(session);
  const Eigen::Vector2f measured = pixelOf(state, without, forearmAt(angleOf("elbow.csv", row))),
                        simulated = pixelOf(state, without, forearmAt(angleOf("without.csv", row)));
  EXPECT_EQ(seenAt(without, measured), Seen::ghost);
  EXPECT_EQ(seenAt(without, simulated), Seen::robot);
  EXPECT_GT(state["replay"]["ghost_distance_mm"], 10.0);
  session.press("g");
  EXPECT_EQ(seenAt(picture(session), measured), Seen::background) << "without the ghost";
  session.press("g");

  state = session.press("e");
  EXPECT_EQ(state["replay"]["with_effects"], true);
  EXPECT_LT(state["replay"]["ghost_distance_mm"], 0.1);
  EXPECT_TRUE(state["replay"]["outside_s"].empty());
  const Image with = picture(session);
  EXPECT_EQ(seenAt(with, measured), Seen::ghost);
  EXPECT_EQ(seenAt(with, simulated), Seen::background) << "the robot has moved onto the ghost";
  session.press("q");
  EXPECT_EQ(session.exitStatus(), 0);
}

/// Tests every key of a replay's help that a run has not, or has with another meaning.
TEST_F(ReplayWindowTest, EveryKeyDoesWhatTheHelpSays) {
  Session session(*server_, folder_, {"replay", "elbow.csv", "--window", "--out", "run/sim.csv", "--picture-size", "640x480"});
  EXPECT_EQ(session.press("e")["replay"]["with_effects"], false) << "there are none";
  EXPECT_EQ(session.press("g")["replay"]["ghost"], false);
  EXPECT_EQ(session.press("g")["replay"]["ghost"], true);
  EXPECT_EQ(session.press("l")["replay"]["looping"], false);
  EXPECT_EQ(session.press("l")["replay"]["looping"], true);
  EXPECT_EQ(session.press("End")["time_s"], 4);
  json state = session.press("Home");
  EXPECT_EQ(state["time_s"], 0);
  EXPECT_EQ(state["paused"], true);
  EXPECT_EQ(session.press("Right", 2)["replay"]["row"], 2);
  EXPECT_EQ(session.press("Left")["replay"]["row"], 1);
  state = session.press("n");
  EXPECT_EQ(state["time_s"], state["replay"]["outside_s"][0][0]);
  const std::string signal = session.press("comma", 20)["replay"]["signal"];
  EXPECT_NE(session.press("period")["replay"]["signal"], signal);
  EXPECT_EQ(session.press("bracketleft")["speed"], 0.5);
  session.press("Home");
  EXPECT_EQ(session.press("space")["paused"], false);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_GT(session.press("0")["time_s"], 0.05);
  session.press("Escape");
  EXPECT_EQ(session.exitStatus(), 0);
}

TEST_F(ReplayWindowTest, SameBitsAsWithoutAWindow) {
  ASSERT_EQ(runProgram({"replay", "elbow.csv", "--effects", "lag.json", "--out", "plain.csv"}, folder_).status, 0);
  Session session(*server_, folder_, {"replay", "elbow.csv", "--window", "--effects", "lag.json", "--out", "run/sim.csv"});
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);
  EXPECT_EQ(contentOf(folder_ / "plain.csv"), contentOf(folder_ / "run" / "sim.csv"));
}

}  // namespace
}  // namespace musclesim
