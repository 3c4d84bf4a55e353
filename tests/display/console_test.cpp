#include "simulation/display/console.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {
namespace {

class ConsoleOfTwelveMuscles : public testing::Test {
 protected:
  void SetUp() override { hands.note(Action(12, 0.2)); }
  std::shared_ptr<const ShownRun> run = std::make_shared<ShownRun>(ShownRun{std::make_shared<Hands>(12), "twelve", "still", "run.csv"});
  Hands& hands = *run->hands;
  Pace pace{1};
  Console console{run, pace};
};

TEST_F(ConsoleOfTwelveMuscles, NoKeyHasTwoMeanings) {
  for (const auto& bindings : {Console::bindingsOfRun(), Console::bindingsOfReplay()}) {
    std::set<int> seen;
    for (const auto& binding : bindings) {
      EXPECT_FALSE(binding.meaning.empty());
      for (const int code : binding.codes) EXPECT_TRUE(seen.insert(code).second) << code;
    }
  }
}

TEST_F(ConsoleOfTwelveMuscles, SelectionDoesNotWrap) {
  EXPECT_EQ(console.selected(), -1);
  console.press(',');
  EXPECT_EQ(console.selected(), -1);
  console.press('.');
  EXPECT_EQ(console.selected(), 0);
  console.press(',');
  EXPECT_EQ(console.selected(), 0);
  console.press('9');
  for (int i = 0; i < 5; ++i) console.press('.');
  EXPECT_EQ(console.selected(), 11);
}

TEST_F(ConsoleOfTwelveMuscles, PressureGoesInHundredthsAndStaysInRange) {
  console.press('+');
  EXPECT_FALSE(hands.isManual()) << "nothing is selected";
  console.press('3');
  console.press('=');
  EXPECT_TRUE(hands.isManual());
  EXPECT_EQ(hands.pressures()[3], 0.21);
  for (int i = 0; i < 29; ++i) console.press('+');
  EXPECT_EQ(hands.pressures()[3], 0.5);
  EXPECT_EQ(hands.pressures()[2], 0.2);
  for (int i = 0; i < 200; ++i) console.press('-');
  EXPECT_EQ(hands.pressures()[3], 0);
  for (int i = 0; i < 200; ++i) console.press('+');
  EXPECT_EQ(hands.pressures()[3], 1);
}

TEST_F(ConsoleOfTwelveMuscles, AfterVentingTheWholeRobotComesIntoView) {
  const Bounds hanging{{-200, -2000, -200}, {200, 400, 200}};
  const auto draw = [&] {
    for (int picture = 0; picture < 200; ++picture) console.keepInView(hanging, 640, 480);
    return console.camera.shows(hanging.low, hanging.high, 640, 480);
  };
  EXPECT_FALSE(draw());
  console.press('r');
  EXPECT_TRUE(draw());
  EXPECT_LT(console.camera.distance_mm, 10000) << "and no farther away than needed";
  for (int i = 0; i < 20; ++i) console.press(key::up);
  EXPECT_FALSE(draw()) << "the user's view stays";
}

TEST_F(ConsoleOfTwelveMuscles, CapitalsCount) {
  EXPECT_TRUE(console.press('I'));
  EXPECT_TRUE(hands.isManual());
}

TEST_F(ConsoleOfTwelveMuscles, UnboundKeysDoNothing) {
  const auto before = console.state();
  for (const int code : {int{'x'}, int{'?'}, 1, key::left, 5000}) EXPECT_FALSE(console.press(code));
  EXPECT_EQ(console.state(), before);
}

TEST_F(ConsoleOfTwelveMuscles, AStateThatWasKeptIsAskedForAgain) {
  console.press('b');
  EXPECT_FALSE(console.wanted_run) << "nothing is kept yet";
  hands.sample(0);
  hands.set(4, 0.7);
  hands.sample(0.01);
  console.press('k');
  hands.sample(0.02);
  console.press('b');
  ASSERT_TRUE(console.wanted_run);
  EXPECT_TRUE(pace.isPaused());
  EXPECT_EQ(console.wanted_run->robot, "twelve");
  EXPECT_EQ(console.wanted_run->controller, "still");
  EXPECT_EQ(console.wanted_run->recording, "run.csv");
  EXPECT_EQ(console.wanted_run->repeated.step_count, 2);
  EXPECT_EQ(console.wanted_run->repeated.time_s, 0.01);
  EXPECT_EQ(console.wanted_run->repeated.at(0), UserInput{});
  EXPECT_EQ(console.wanted_run->repeated.at(1).pressures[4], 0.7);
}

TEST_F(ConsoleOfTwelveMuscles, AnotherRunKeepsWhatIsKept) {
  console.press('k');
  console.press('9');
  console.press(',');
  for (int i = 0; i < 4; ++i) console.press('.');
  EXPECT_EQ(console.selected(), 11);
  console.attach(std::make_shared<ShownRun>(ShownRun{std::make_shared<Hands>(2), "two", "other", "run-2.csv"}));
  EXPECT_EQ(console.selected(), -1) << "there is no such muscle";
  EXPECT_EQ(console.saved().size(), 1u);
  console.press(key::home);
  EXPECT_EQ(console.wanted_run->robot, "two");
  EXPECT_EQ(console.wanted_run->repeated.step_count, 0);
}

TEST_F(ConsoleOfTwelveMuscles, TargetGoesUpAndDown) {
  console.press(key::page_up);
  EXPECT_FALSE(hands.movedTargetMm()) << "there is none";
  console.target_mm = Eigen::Vector3f(1, 2, 3);
  for (int i = 0; i < 3; ++i) console.press(key::page_up);
  console.press(key::page_down);
  EXPECT_EQ(*hands.movedTargetMm(), Vector(1, 22, 3));
}

/// docs/user/window.md lists the same keys as the help.
TEST(KeysOfTheWindow, AreDocumented) {
  const std::string page = readTextFile(MUSCLESIM_WINDOW_PAGE, 1 << 20);
  for (const auto& bindings : {Console::bindingsOfRun(), Console::bindingsOfReplay()})
    for (const auto& binding : bindings)
      EXPECT_NE(page.find("| `" + binding.keys + "` | " + binding.meaning + " |"), std::string::npos)
          << binding.keys << ": " << binding.meaning;
}

}  // namespace
}  // namespace musclesim
