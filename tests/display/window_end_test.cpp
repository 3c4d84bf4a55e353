// How a run in a window ends, and what its files hold then.
#include <csignal>

#include "src/program.h"
#include "window_fixture.h"

namespace musclesim {
namespace {

class WindowEndTest : public WindowTest {
 protected:
  /// Expects that the run failed for this reason and that its files hold the recording up to then.
  void expectWindowLost(Session& session, const std::string& reason) {
    EXPECT_EQ(session.exitStatus(), 5);
    const std::string said = contentOf(folder_ / "output.txt");
    EXPECT_NE(said.find("musclesim: error: the window ended on its own at "), std::string::npos) << said;
    EXPECT_NE(said.find(reason), std::string::npos) << said;
    EXPECT_EQ(sidecar().at("complete"), false);
    EXPECT_EQ(sidecar().at("verdict").at("status"), "window_lost");
    EXPECT_GT(readRecording((folder_ / "run" / "run.csv").string()).time_s.size(), 2u);
    EXPECT_TRUE(fs::exists(folder_ / "run" / "run.svg"));
  }
};

TEST_F(WindowEndTest, ClosingTheWindowEndsTheRunWithCompleteFiles) {
  Session session(*server_, folder_, small_arm);
  session.runUntil(0.1);
  session.requestClose();
  ASSERT_EQ(session.exitStatus(), 0);
  EXPECT_EQ(sidecar().at("complete"), true);
  EXPECT_EQ(sidecar().at("verdict").at("status"), "done");
  EXPECT_GT(readRecording((folder_ / "run" / "run.csv").string()).time_s.size(), 2u);
}

TEST_F(WindowEndTest, ClosingTheWindowBeforeTheEndIsSaid) {
  Session session(*server_, folder_, {"--duration", "1000", "--picture-size", "320x240"});
  session.press("q");
  ASSERT_EQ(session.exitStatus(), 0);
  EXPECT_EQ(sidecar().at("complete"), true);
  const std::string said = contentOf(folder_ / "output.txt");
  EXPECT_NE(said.find("the window was closed: "), std::string::npos) << said;
  EXPECT_NE(said.find(" of 1000 s are recorded"), std::string::npos) << said;
}

TEST_F(WindowEndTest, LossOfTheDisplayEndsTheRunWithReadableFilesThatAreNotComplete) {
  XServer own;
  Session session(own, folder_, small_arm);
  session.runUntil(0.1);
  own.kill();
  expectWindowLost(session, "the connection to the display is lost");
}

TEST_F(WindowEndTest, KilledConnectionEndsTheRunLikewise) {
  Session session(*server_, folder_, small_arm);
  session.runUntil(0.1);
  session.xdotool("search --name musclesim: windowkill");
  expectWindowLost(session, "the connection to the display is lost");
}

TEST_F(WindowEndTest, XErrorEndsTheRunLikewise) {
  Session session(*server_, folder_, small_arm);
  session.runUntil(0.1);
  session.xdotool("search --name musclesim: windowclose");  // destroys it
  expectWindowLost(session, "X error in request");
}

TEST_F(WindowEndTest, InterruptEndsAPausedRun) {
  Session session(*server_, folder_, small_arm);
  session.press("p");
  session.signal(SIGINT);
  EXPECT_EQ(session.exitStatus(), 130);
  EXPECT_EQ(sidecar().at("complete"), false);
}

TEST_F(WindowEndTest, SameBitsAsWithoutAWindow) {
  Session session(*server_, folder_, {"--seed", "5", "--duration", "1.5", "--speed", "3", "--picture-size", "320x240"});
  ASSERT_EQ(session.exitStatus(), 0);
  ASSERT_EQ(runProgram({"--simple", "--seed", "5", "--duration", "1.5", "--out", "plain"}, folder_).status, 0);
  EXPECT_GT(contentOf(folder_ / "plain" / "run.csv").size(), 10000u);
  EXPECT_EQ(contentOf(folder_ / "plain" / "run.csv"), contentOf(folder_ / "run" / "run.csv"));
}

TEST_F(WindowEndTest, DivergenceStandsStillUntilTheUserEndsIt) {
  Session session(*server_, folder_,
                  {"--robot", "elbow", "--controller", "random", "--decision-interval", "0.05", "--substeps", "1", "--step", "0.05",
                   "--speed", "100", "--picture-size", "640x480"});
  for (int i = 0; i < 3000 && !(fs::exists(folder_ / "run" / "run.json") && sidecar().contains("verdict")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(sidecar().at("verdict").at("status"), "diverged");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_TRUE(session.isAlive());
  const json state = session.press("h");
  EXPECT_EQ(state["paused"], true);
  EXPECT_NE(std::string(state["divergence"]).find("diverged at"), std::string::npos);
  session.press("q");
  EXPECT_EQ(session.exitStatus(), 4);
}

}  // namespace
}  // namespace musclesim
