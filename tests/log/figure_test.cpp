#include "musclesim/log/figure.h"

#include <cmath>
#include <random>

#include "log_fixture.h"

namespace musclesim {
namespace {

const std::vector<Color> arm_colors = {{0.75, 0.75, 0.75, "gray"}, {1.0, 0.73, 0.8, "pink"},        {0.73, 0.09, 0.15, "brown"},
                                       {1.0, 0.0, 0.0, "red"},     {1.0, 0.63, 0.0, "orange"},      {0.99, 1.0, 0.0, "yellow"},
                                       {0.0, 1.0, 0.0, "green"},   {0.25, 1.0, 0.83, "aquamarine"}, {0.1, 0.0, 1.0, "blue"},
                                       {0.73, 0.0, 0.96, "purple"}};

/// A synthetic run like the paper's: ten pressures that vary and settle, and the height that follows them.
Recording madeUpRun(int muscle_count, double duration_s) {
  Recording recording;
  recording.info.robot = "arm";
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  recording.signals = {{"hand_y_mm", {}}, {"target_y_mm", {}}, {"activity", {}}};
  std::vector<double> command, pressure;
  for (int i = 0; i < muscle_count; ++i) {
    command.push_back(uniform(random));
    pressure.push_back(command.back());
    recording.signals.push_back({"command_" + std::to_string(i), {}});
    recording.signals.push_back({"pressure_" + std::to_string(i), {}});
  }
  double height_mm = -241;
  for (int step = 0; step * 0.05 < duration_s; ++step) {
    const double time_s = step * 0.05;
    const bool settled = time_s > 0.45 * duration_s && std::fmod(time_s, 0.3 * duration_s) > 12;
    const double aim_mm = settled ? -3 : -120 + 110 * std::sin(time_s / 9) * std::cos(time_s / 23);
    height_mm += 0.03 * (aim_mm - height_mm) + (settled ? 0.3 : 3.0) * normal(random);
    recording.time_s.push_back(time_s);
    recording.signals[0].values.push_back(height_mm);
    recording.signals[1].values.push_back(time_s < 0.8 * duration_s ? 0 : 50);
    recording.signals[2].values.push_back(100 / (1 + std::abs(height_mm) / 8));
    for (std::size_t i = 0; i < command.size(); ++i) {
      if (step % 20 == 0) command[i] = std::clamp(command[i] + (settled ? 0.005 : 0.12) * normal(random), 0.0, 1.0);
      pressure[i] += 0.2 * (command[i] - pressure[i]);
      recording.signals[3 + 2 * i].values.push_back(command[i]);
      recording.signals[4 + 2 * i].values.push_back(pressure[i]);
    }
  }
  return recording;
}

/// Set MUSCLESIM_FIGURES=<folder> to keep the figures of these tests for inspection.
std::string drawn(const Recording& recording, const std::string& name, const std::string& title = "") {
  const std::string svg = runFigureSvg(recording, arm_colors, title.empty() ? name : title);
  if (const char* folder = std::getenv("MUSCLESIM_FIGURES")) {
    writeText(std::string(folder) + "/" + name + ".svg", svg);
    writeRecording(recording, std::string(folder) + "/" + name + ".csv");
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
  EXPECT_EQ(svg.find("http", svg.find("http") + 1), std::string::npos) << "nothing is fetched from elsewhere";
  return svg;
}

void dropSignals(Recording& recording, const std::string& prefix) {
  std::erase_if(recording.signals, [&](const Signal& signal) { return signal.name.starts_with(prefix); });
}

TEST(Figure, ThePapersFigureEleven) {
  const auto svg = drawn(madeUpRun(10, 300), "arm", "RoboticArm, height task, seed 1");
  EXPECT_TRUE(hasWords(svg, {"height (mm)", "activity", "pressure (fraction)", "time (s)", "height of the hand", "target", "0 gray",
                             "5 yellow", "7 aquamarine", "9 purple", "RoboticArm, height task, seed 1", "(pressure_3)"}));
  EXPECT_LT(svg.size(), 600'000u) << "6000 samples are thinned to the pixels";
}

TEST(Figure, WithoutMeasuredPressuresTheCommands) {
  auto recording = madeUpRun(2, 60);
  dropSignals(recording, "pressure_");
  EXPECT_TRUE(hasWords(drawn(recording, "commands"), {"command (fraction)", "(command_1)"}));
}

TEST(Figure, WithoutHandTheAnglesOrLengthsOrForces) {
  auto recording = madeUpRun(2, 60);
  dropSignals(recording, "hand_");
  auto values = recording.find("pressure_0")->values;
  for (auto& value : values) value = 200 + 50 * value;
  recording.signals.push_back({"force_0_N", values});
  EXPECT_TRUE(hasWords(drawn(recording, "forces"), {"force (N)"}));
  recording.signals.push_back({"length_0_mm", values});
  EXPECT_TRUE(hasWords(drawn(recording, "lengths"), {"length (mm)", "0 gray"}));
  recording.signals.push_back({"angle_elbow_deg", values});
  recording.signals.push_back({"angle_wrist_deg", values});
  EXPECT_TRUE(hasWords(drawn(recording, "angles"), {"angle (degrees)", "elbow", "wrist"}));
}

TEST(Figure, MoreMusclesThanColors) {
  EXPECT_TRUE(hasWords(drawn(madeUpRun(30, 60), "thirty"), {"9 purple", "10 blue", "29"}));
}

TEST(Figure, GapsSpikesAndHostileTitles) {
  auto recording = madeUpRun(3, 60);
  for (std::size_t i = 300; i < 500; ++i) recording.signals[0].values[i] = std::nan("");
  recording.signals[0].values[100] = 400;
  EXPECT_TRUE(hasWords(drawn(recording, "gaps", "<script>alert(1)</script> & \"co\""), {"&lt;script&gt;", "&amp; &quot;co&quot;"}));
}

TEST(Figure, SmallAndOddRecordings) {
  auto one = madeUpRun(1, 0.04);
  ASSERT_EQ(one.time_s.size(), 1u);
  drawn(one, "one_sample");
  auto huge = madeUpRun(1, 10);
  huge.signals[0].values[3] = 1e308;
  huge.signals[0].values[4] = -1e308;
  drawn(huge, "huge");
  auto only_commands = madeUpRun(1, 10);
  for (const char* prefix : {"hand_", "target_", "activity", "pressure_"}) dropSignals(only_commands, prefix);
  drawn(only_commands, "only_commands");
  EXPECT_TRUE(runFigureSvg({}, {}, "empty").ends_with("</svg>\n"));
}

TEST(Figure, WritesAFile) {
  const TemporaryFolder folder;
  const auto recording = madeUpRun(2, 10);
  writeRunFigure(recording, arm_colors, "a run", folder.file("run.svg"));
  EXPECT_EQ(readText(folder.file("run.svg")), runFigureSvg(recording, arm_colors, "a run"));
  EXPECT_THROW(writeRunFigure(recording, arm_colors, "a run", folder.file("no/run.svg")), IoError);
}

}  // namespace
}  // namespace musclesim
