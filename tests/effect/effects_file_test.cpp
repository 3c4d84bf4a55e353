#include "musclesim/effect/effects_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

std::string withEffects(const std::string& list) {
  return R"({"format": "musclesim-effects-1", "effects": )" + list + "}";
}

TEST(EffectsFile, ReadsWhatItSays) {
  const auto effects =
      parseEffects(withEffects(R"([{"id": "valve_lag", "component": "muscle_1", "parameters": {"fill_time_constant_s": 0.08}},
                                                    {"id": "transport_delay"}])"),
                   "e.json");
  ASSERT_EQ(effects.size(), 2u);
  EXPECT_EQ(effects[0], (ActiveEffect{"valve_lag", "muscle_1", {{"fill_time_constant_s", 0.08}}}));
  EXPECT_EQ(effects[1], (ActiveEffect{"transport_delay", "all", {}}));
  EXPECT_EQ(parseEffects(effectsText(effects), "again"), effects);
}

TEST(EffectsFile, RefusesWhatIsWrongAndSaysWhere) {
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"[]", {"e.json"}},
      {"{", {"e.json"}},
      {R"({"effects": []})", {"\"format\" is missing"}},
      {R"({"format": "musclesim-recording-1", "effects": []})", {"e.json:1", "musclesim-effects-1"}},
      {R"({"format": "musclesim-effects-1"})", {"\"effects\" is missing"}},
      {R"({"format": "musclesim-effects-1", "effects": [], "more": 1})", {"\"more\""}},
      {withEffects("{}"), {"effects = {...}", "list"}},
      {withEffects(R"([{"id": "valve_leg"}])"), {"effects[0]", "did you mean \"valve_lag\"?"}},
      {withEffects(R"([{"id": "valve_lag", "parameters": {"tau": 1}}])"), {"effects[0]", "\"tau\"", "fill_time_constant_s"}},
      {withEffects(R"([{"id": "valve_lag", "parameters": {"fill_time_constant_s": -1}}])"), {"fill_time_constant_s = -1 s", "0 .. 5 s"}},
      {withEffects(R"([{"id": "valve_lag", "parameters": {"fill_time_constant_s": "inf"}}])"), {"0 .. 5 s"}},
      {withEffects(R"([{"id": "valve_lag", "parameters": {"fill_time_constant_s": null}}])"), {"effects[0].parameters"}},
      {withEffects(R"([{"component": "all"}])"), {"\"id\""}},
      {withEffects(R"([{"id": "valve_lag", "strength": 1}])"), {"effects[0].strength"}},
  };
  for (const auto& wrong : cases) {
    const std::string message = messageOf<BadFile>([&] { parseEffects(wrong.text, "e.json"); });
    for (const std::string& part : wrong.parts) EXPECT_TRUE(contains(message, part)) << wrong.text;
  }
}

TEST(EffectsFile, DoesNotWriteWhatItWouldRefuse) {
  EXPECT_THROW(effectsText({{"valve_leg", "all", {}}}), BadParameter);
  EXPECT_THROW(effectsText({{"valve_lag", "all", {{"fill_time_constant_s", std::numeric_limits<double>::quiet_NaN()}}}}), BadParameter);
}

}  // namespace
}  // namespace musclesim
