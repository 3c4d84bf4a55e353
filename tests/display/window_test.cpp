// What keys and mouse do in the window.
#include <set>

#include "simulation/display/console.h"
#include "src/program.h"
#include "window_fixture.h"

namespace musclesim {
namespace {

/// Pixels with the red of selected muscles; the red cap of muscle 3 is brighter.
long selectedPixels(const Image& image) {
  long count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    count += image.rgb[i] > 80 && image.rgb[i] < 190 && 6 * image.rgb[i + 1] < image.rgb[i] && 6 * image.rgb[i + 2] < image.rgb[i] &&
             image.rgb[i + 1] > 4;
  return count;
}

constexpr int robot_list_y = 95;  ///< in the panel, pixels from the upper edge
constexpr int lists_px = 52;      ///< height of the lists of robots and controllers and of the buttons below

TEST_F(WindowTest, HandSetsAPressureThatIsRecordedAndTheMuscleTurnsRed) {
  Session session(*server_, folder_, small_arm);
  EXPECT_EQ(session.press("i")["manual"], true);
  EXPECT_EQ(session.press("r")["pressures"], json(std::vector<double>(10, 0.0)));
  const long before = selectedPixels(picture(session));
  EXPECT_EQ(session.press("3")["selected"], 3);
  EXPECT_EQ(session.press("plus", 50)["pressures"][3], 0.5);
  EXPECT_GT(selectedPixels(picture(session)), before + 150);
  EXPECT_EQ(session.press("minus")["pressures"][3], 0.49);
  EXPECT_EQ(session.press("equal")["pressures"][3], 0.5);
  EXPECT_EQ(session.press("KP_Subtract", 2)["pressures"][3], 0.48);
  EXPECT_EQ(session.press("KP_Add", 2)["pressures"][3], 0.5);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(session.press("i")["manual"], false);
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);

  const Recording recording = readRecording((folder_ / "run" / "run.csv").string());
  const auto& command = recording.find("command_3")->values;
  EXPECT_EQ(*std::max_element(command.begin(), command.end()), 0.5);
  EXPECT_EQ(sidecar().at("by_hand_s").size(), 1u);
  EXPECT_TRUE(fs::exists(folder_ / "run" / "run.svg"));

  const ProgramResult replayed = runProgram({"replay", "run/run.csv", "--json"}, folder_);
  const json verdict = json::parse(replayed.out.substr(replayed.out.rfind('\n', replayed.out.size() - 2) + 1));
  EXPECT_EQ(verdict["signals"]["length_3_mm"]["largest"], 0) << "a session by hand is a recording like any other";
}

/// Tests every other key of the help.
TEST_F(WindowTest, EveryKeyDoesWhatTheHelpSays) {
  Session session(*server_, folder_, small_arm);
  // In other tests.
  std::set<int> tried = {'i', 'r', '+', 's', 'q', 'k', 'b', key::home, key::page_down};
  const auto press = [&](const std::string& key, int code) {
    tried.insert(code);
    return session.press(key);
  };
  for (int muscle = 0; muscle <= 9; ++muscle) EXPECT_EQ(press(std::to_string(muscle), '0' + muscle)["selected"], muscle);
  EXPECT_EQ(press("period", '.')["selected"], 9) << "no wrapping";
  EXPECT_EQ(press("comma", ',')["selected"], 8);

  json state = press("p", 'p');
  EXPECT_EQ(state["paused"], true);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const double paused_at_s = session.press("0")["time_s"];
  EXPECT_NEAR(paused_at_s, state["time_s"], 0.0101);
  press("Right", key::right);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  state = session.press("0");
  EXPECT_NEAR(state["time_s"], paused_at_s + 0.01, 1e-9);
  EXPECT_EQ(state["paused"], true);
  EXPECT_EQ(press("space", ' ')["paused"], false);

  EXPECT_EQ(press("bracketright", ']')["speed"], 2);
  EXPECT_EQ(press("bracketleft", '[')["speed"], 1);
  const double distance = state["camera"]["distance_mm"];
  EXPECT_LT(press("Up", key::up)["camera"]["distance_mm"], 0.95 * distance);
  EXPECT_NEAR(press("Down", key::down)["camera"]["distance_mm"], distance, 1e-2);
  session.press("Down");
  EXPECT_EQ(press("c", 'c')["camera"], state["camera"]);
  for (const auto& [name, code, member] : std::vector<std::tuple<std::string, int, std::string>>{{"t", 't', "transparent"},
                                                                                                 {"a", 'a', "arrows"},
                                                                                                 {"m", 'm', "color_tension"},
                                                                                                 {"f", 'f', "frames"},
                                                                                                 {"h", 'h', "help"},
                                                                                                 {"F1", key::f1, "help"}}) {
    const bool before = session.press("0")[member];
    EXPECT_EQ(press(name, code)[member], !before) << name;
    EXPECT_EQ(press(name, code)[member], before) << name;
  }
  const bool has_panel = state["panel"];
  if (has_panel) {
    EXPECT_EQ(press("Tab", key::tab)["panel"], false);
    EXPECT_EQ(press("Tab", key::tab)["panel"], true);
  }
  tried.insert(key::tab);
  EXPECT_EQ(press("v", 'v')["video"], true);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(session.press("v")["video"], false);
  EXPECT_EQ(press("Escape", key::escape)["closed"], true);
  EXPECT_EQ(session.exitStatus(), 0);
  EXPECT_TRUE(fs::exists(folder_ / "run" / "window-1.mp4") || fs::exists(folder_ / "run" / "window-1-frames"));
  EXPECT_EQ(sidecar().at("complete"), true);

  for (const auto& binding : Console::bindingsOfRun())
    EXPECT_TRUE(std::any_of(binding.codes.begin(), binding.codes.end(), [&](int code) { return tried.count(code) > 0; })) << binding.keys;
}

TEST_F(WindowTest, MouseRotatesZoomsAndSelects) {
  Session session(*server_, folder_, {"--robot", "elbow", "--controller", "hold", "--picture-size", "640x480"});
  const json first = session.press("p");
  const Image straight = picture(session);
  session.xdotool("mousemove 100 100 mousedown 1 mousemove 150 110 mousemove 200 120 mouseup 1");
  json state = session.press("t");
  EXPECT_NEAR(std::abs(double(state["camera"]["azimuth_deg"]) - double(first["camera"]["azimuth_deg"])), 40, 1.5);
  EXPECT_GT(state["camera"]["elevation_deg"], double(first["camera"]["elevation_deg"]) + 5);
  session.press("t");
  EXPECT_GT(differingShare(straight, picture(session)), 0.005) << "rotation";
  const Image rotated_picture = picture(session);
  session.xdotool("click 4 click 4 click 4");
  state = session.press("0");
  EXPECT_LT(state["camera"]["distance_mm"], 0.8 * double(first["camera"]["distance_mm"]));
  EXPECT_GT(differingShare(rotated_picture, picture(session)), 0.01) << "zoom";

  // Muscle 1 stands left of the middle of the scene in the first view, muscle 0 right of it.
  state = session.press("c");
  const int scene_px = straight.width;
  session.press("5");
  const auto muscle = cameraOf(state).pixelOf({-35, 120, 0}, static_cast<float>(scene_px), 480);
  ASSERT_TRUE(muscle);
  session.xdotool("mousemove " + std::to_string(std::lround(muscle->x())) + " " + std::to_string(std::lround(muscle->y())) + " click 1");
  EXPECT_EQ(session.press("t")["selected"], 1);

  if (first["panel"]) {  // the first slider, at its middle: right of the scene, in the row below the lines of the run
    session.xdotool("mousemove " + std::to_string(scene_px + 181) + " " + std::to_string(96 + lists_px) + " click 1");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    state = session.press("t");
    EXPECT_EQ(state["manual"], true);
    EXPECT_NEAR(state["pressures"][0], 0.5, 0.06);
  }
  session.press("q");
  EXPECT_EQ(session.exitStatus(), 0);
}

/// The value after "musclesim replay --json" of the largest difference between a recording and its replay.
double largestDifference(const fs::path& folder, const std::string& recording, const std::string& signal) {
  const ProgramResult replayed = runProgram({"replay", recording, "--json"}, folder);
  const json verdict = json::parse(replayed.out.substr(replayed.out.rfind('\n', replayed.out.size() - 2) + 1));
  return verdict["signals"][signal]["largest"];
}

const std::vector<std::string> elbow_from_the_front = {"--robot",  "elbow",   "--controller",   "hold",
                                                       "--camera", "0,0,900", "--picture-size", "950x480"};

TEST_F(WindowTest, MousePullsAtABoneAndAReplayRepeatsIt) {
  Session session(*server_, folder_, elbow_from_the_front);
  session.runUntil(0.2);
  const Image before = picture(session);
  const json state = session.press("0");
  const auto hand = cameraOf(state).pixelOf({0, -200, 0}, static_cast<float>(before.width), 480);
  const auto at = [&](float right_px) {
    return std::to_string(std::lround(hand->x() + right_px)) + " " + std::to_string(std::lround(hand->y()));
  };
  session.xdotool("mousemove " + at(0) + " keydown ctrl mousedown 1 keyup ctrl sleep 0.1 mousemove " + at(30) + " sleep 0.1 mousemove " +
                  at(90) + " sleep 0.7");
  const json held = session.press("0");
  EXPECT_GT(held["pull_N"], 5.0);
  EXPECT_EQ(held["camera"], state["camera"]) << "the drag turns nothing";
  const Image pulled = picture(session);
  session.xdotool("mouseup 1 sleep 0.3");
  EXPECT_TRUE(session.press("0")["pull_N"].is_null());
  EXPECT_GT(differingShare(before, pulled), 0.005);
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);

  const Recording recording = readRecording((folder_ / "run" / "run.csv").string());
  const auto& angle = recording.find("angle_elbow_deg")->values;
  EXPECT_GT(*std::ranges::max_element(angle), angle.front() + 5) << "to the right";
  EXPECT_EQ(sidecar().at("by_hand_s").size(), 0u);
  EXPECT_GE(sidecar().at("pulls").size(), 2u);
  EXPECT_FALSE(sidecar().at("pulls").back().contains("part")) << "the last one lets go";
  EXPECT_EQ(largestDifference(folder_, "run/run.csv", "angle_elbow_deg"), 0);
}

TEST_F(WindowTest, StatesComeBackToTheBit) {
  Session session(*server_, folder_, {"--seed", "3", "--picture-size", "640x480"});
  session.runUntil(0.3);
  session.press("2");
  session.press("plus", 20);
  session.press("p");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const double kept_s = session.press("k")["time_s"];
  session.press("p");
  session.runUntil(kept_s + 0.3);
  session.press("b");
  json state;
  for (int i = 0; i < 1000; ++i) {
    state = session.press("2");
    if (state["time_s"] == kept_s && state["repeating"] == false) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(state["time_s"], kept_s);
  EXPECT_EQ(state["paused"], true);
  EXPECT_EQ(state["manual"], true);
  EXPECT_EQ(state["saved"], 1);
  session.press("p");
  session.runUntil(kept_s + 0.1);
  session.press("Home");
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);

  const std::string first = contentOf(folder_ / "run" / "run.csv"), second = contentOf(folder_ / "run" / "run-2.csv");
  const auto rows = static_cast<std::ptrdiff_t>(std::lround(kept_s / 0.01)) + 2;  // with the header
  std::size_t same = 0;
  for (std::ptrdiff_t row = 0; row < rows; ++row) same = first.find('\n', same) + 1;
  EXPECT_EQ(first.substr(0, same), second.substr(0, same));
  const json again = json::parse(contentOf(folder_ / "run" / "run-2.json"));
  EXPECT_EQ(again.at("repeats").at("recording"), "run.csv");
  EXPECT_NEAR(again.at("repeats").at("until_s"), kept_s, 1e-9);
  for (const char* name : {"run.json", "run-2.json"})
    EXPECT_EQ(json::parse(contentOf(folder_ / "run" / name)).at("complete"), true) << name;
  EXPECT_EQ(largestDifference(folder_, "run/run-2.csv", "length_3_mm"), 0);
}

TEST_F(WindowTest, TargetIsMovedByKeysAndByTheMouse) {
  Session session(*server_, folder_, {"--task", "reach", "--picture-size", "640x480"});
  session.runUntil(0.1);
  json state = session.press("Next", 3);  // Page down
  EXPECT_EQ(session.press("0")["manual"], false);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  state = session.press("0");
  EXPECT_EQ(state["target_mm"], json({-300, -30, 150}));
  const Image view = picture(session);
  const auto at = cameraOf(state).pixelOf({-300, -30, 150}, static_cast<float>(view.width), 480);
  const std::string x = std::to_string(std::lround(at->x())), y = std::to_string(std::lround(at->y()));
  const std::string higher = std::to_string(std::lround(at->y()) - 60);
  session.xdotool("mousemove " + x + " " + y + " keydown ctrl mousedown 1 keyup ctrl mousemove " + x + " " + higher +
                  " sleep 0.1 mouseup 1");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_GT(session.press("0")["target_mm"][1], 20.0);
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);
  const Recording recording = readRecording((folder_ / "run" / "run.csv").string());
  const auto& recorded = recording.find("target_y_mm")->values;
  EXPECT_EQ(recorded.front(), 0);
  EXPECT_GT(recorded.back(), 20);
}

/// The lists of robots and controllers, and what happens if the wanted run cannot be made.
TEST_F(WindowTest, MouseChoosesRobotAndController) {
  Session session(*server_, folder_, {"--robot", "elbow", "--controller", "hold", "--picture-size", "1000x600"});
  json state = session.press("0");
  if (!state["panel"]) GTEST_SKIP() << "this build has no panel";
  const auto choose = [&](int x, int entry) {  // of a list below the lines of the run
    for (const int y : {robot_list_y, robot_list_y + 24 + 20 * entry}) {
      session.xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y) + " click 1");
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
    }
    return session.press("0");
  };
  state = choose(1000 - 230, 3);
  EXPECT_EQ(state["robot"], "rig");
  EXPECT_EQ(state["pressures"].size(), 1u);
  EXPECT_EQ(state["controller"], "triangle") << "its usual one";
  state = choose(1000 - 80, 0);
  EXPECT_EQ(state["controller"], "triangle") << "aasm needs a hand, which the rig has not: the run before goes on";
  state = choose(1000 - 80, 3);
  EXPECT_EQ(state["controller"], "hold");
  session.press("q");
  EXPECT_EQ(session.exitStatus(), 0);
  EXPECT_EQ(sidecar().at("robot"), "elbow");
  EXPECT_EQ(sidecar().at("complete"), true);
  std::vector<std::string> robots, controllers;
  for (const char* name : {"run.json", "run-2.json", "run-3.json", "run-4.json"}) {
    const json other = json::parse(contentOf(folder_ / "run" / name));
    EXPECT_EQ(other.at("complete"), true) << name;
    robots.push_back(other.at("robot"));
    controllers.push_back(other.at("controller"));
  }
  EXPECT_EQ(robots, (std::vector<std::string>{"elbow", "rig", "rig", "rig"}));
  EXPECT_EQ(controllers, (std::vector<std::string>{"hold", "triangle", "triangle", "hold"}));
}

TEST_F(WindowTest, MouseChoosesPlots) {
  Session session(*server_, folder_, {"--robot", "elbow", "--controller", "hold", "--picture-size", "1000x600"});
  json state = session.press("p");
  if (!state["panel"]) GTEST_SKIP() << "this build has no panel";
  EXPECT_EQ(state["hidden_plots"], json({"hand x", "hand z"}));
  const std::string x = std::to_string(1000 - 253);  // the list of plots, below the two sliders; it opens downwards
  for (const int y : {154, 199}) {                   // its second entry
    session.xdotool("mousemove " + x + " " + std::to_string(y + lists_px) + " click 1");
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
  }
  state = session.press("0");
  EXPECT_EQ(state["hidden_plots"], json({"angles", "hand x", "hand z"}));
  session.press("q");
  EXPECT_EQ(session.exitStatus(), 0);
}

}  // namespace
}  // namespace musclesim
