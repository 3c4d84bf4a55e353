#include "simulation/display/console.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {
namespace {

class Still final : public Controller {
 public:
  Action output(const State&) override { return Action(12, 0.2); }
};

class ConsoleOfTwelveMuscles : public testing::Test {
 protected:
  void SetUp() override { hands.output(State{}); }
  ManualController hands{std::make_unique<Still>(), 12};
  Pace pace{1};
  Console console{hands, pace, Camera{}};
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
