// The words and drawings of effects.
#include "diagnosis/words/effect_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "diagnosis/report/effect_sketch.h"
#include "musclesim/effect/catalogue.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(EffectWords, HasWordsAndADrawingForEveryEffectOfTheCatalogue) {
  std::set<std::string> titles;
  for (const EffectInfo& info : effectCatalogue()) {
    EXPECT_TRUE(titles.insert(effectTitle(info.id)).second) << info.id << ": two effects have one title";
    EXPECT_GT(effectExplanation(info.id).size(), 40U) << info.id;
    EXPECT_TRUE(contains(effectSketch(info.id), "<svg")) << info.id;
    for (const EffectParameter& parameter : info.parameters) {
      if (!parameter.choices.empty() || parameter.shape) continue;
      FoundEffect found{info.id, "all", 0.9, {}};
      const double value = 0.3 * parameter.usual_low + 0.7 * parameter.usual_high;
      found.parameters[parameter.name] = {value, value, value};
      const std::vector<ParameterLine> lines = parameterLines(found, {});
      ASSERT_EQ(lines.size(), 1U) << info.id << " " << parameter.name;
      EXPECT_FALSE(lines.front().is_beyond) << info.id << " " << parameter.name;
      EXPECT_FALSE(contains(lines.front().label, "_")) << info.id << " " << parameter.name;
      EXPECT_NE(lines.front().label, parameter.name) << info.id << ": a parameter without words";
      EXPECT_TRUE(contains(claimSentences({found}, {}).front(), lines.front().value)) << info.id << " " << parameter.name;
    }
  }
  EXPECT_EQ(effectSketch("no_such_effect"), "");
}

TEST(EffectWords, SaysSharesInPercentAndShortTimesInMilliseconds) {
  EXPECT_EQ(claimSentences({{"transport_delay", "all", 1, {{"delay_s", {0.0312, 0.0302, 0.0322}}}}}, {}),
            std::vector<std::string>{"The pressure of every muscle comes late: a dead time of 31.2 ms."});
  EXPECT_EQ(claimSentences({{"command_dead_band", "muscle_0", 1, {{"threshold", {0.05, 0.04, 0.06}}}}}, {}),
            std::vector<std::string>{"Small commands do not open the valve of muscle 0: nothing happens below 5 % of full scale."});
  EXPECT_EQ(claimSentences({{"creep", "muscle_0", 1, {{"amount", {0.1, 0.1, 0.1}}, {"time_constant_s", {3, 2.8, 3.2}}}}}, {}),
            std::vector<std::string>{"Muscle 0 yields slowly under load: by 10 % of the immediate change and within about 3 s."});
}

TEST(EffectWords, SaysOnWhichSideOfTheModelAMachineIs) {
  const auto claim = [](double gain) {
    return claimSentences({{"force_gain", "muscle_1", 1, {{"gain", {gain, gain, gain}}}}}, {}).front();
  };
  EXPECT_EQ(claim(0.8), "Muscle 1 is weaker than in the model: a factor of 0.8.");
  EXPECT_EQ(claim(1.2), "Muscle 1 is stronger than in the model: a factor of 1.2.");
}

TEST(EffectWords, TellsNumbersBeyondWhatIsUsual) {
  const auto is_beyond = [](const std::string& id, const std::string& parameter, double value) {
    const double half = 0.01 * std::abs(value);
    return parameterLines({id, "all", 1, {{parameter, {value, value - half, value + half}}}}, {}).at(0).is_beyond;
  };
  EXPECT_TRUE(is_beyond("volume_coupling", "polytropic_exponent", 1.6));
  EXPECT_TRUE(is_beyond("volume_coupling", "polytropic_exponent", 0.9)) << "air is at least isothermal";
  EXPECT_TRUE(is_beyond("transport_delay", "delay_s", 0.9));
  EXPECT_FALSE(is_beyond("transport_delay", "delay_s", 0.002)) << "a short dead time is nothing unusual";
  EXPECT_TRUE(is_beyond("payload", "mass_kg", -0.9));
  EXPECT_FALSE(is_beyond("joint_stiffness", "rest_deg", 70)) << "a spring may rest anywhere";
  EXPECT_TRUE(is_beyond("flow_limit", "fill_rate_per_s", 0.01)) << "a limit is strong where it is low";
  EXPECT_FALSE(is_beyond("flow_limit", "fill_rate_per_s", 1e4));
}

TEST(EffectWords, SaysThatACauseDoesNotHoldOnUnseenData) {
  FoundEffect delay{"transport_delay", "all", 0.9, {{"delay_s", {0.0312, 0.0302, 0.0322}}}};
  delay.removes_percent = -7.0;
  EXPECT_EQ(claimSentences({delay}, {}).front(),
            "The pressure of every muscle comes late: a dead time of 31.2 ms. On the data not used for fitting the gap is larger with it.");
  delay.removes_percent = -0.2;
  EXPECT_TRUE(claimSentences({delay}, {}).front().ends_with("31.2 ms."));
}

TEST(EffectWords, GivesReadingsTheirUnit) {
  const FoundEffect bias{"sensor_bias", "signal_angle_elbow", 1, {{"offset", {1.72, 1.69, 1.75}}}};
  EXPECT_EQ(claimSentences({bias}, {"angle_elbow_deg", "length_0_mm"}).front(),
            "The reading of the angle of the elbow joint is off by a constant: 1.72 deg.");
}

TEST(EffectWords, LeavesOutWhatDoesNothingAndSaysWhatIsNotKnown) {
  const FoundEffect limit{"flow_limit",
                          "muscle_0",
                          1,
                          {{"fill_rate_per_s", {1, 0, 774597}}, {"vent_rate_per_s", {0.42, 0.37, 0.49}}, {"proportional_band", {0, 0, 0}}}};
  const std::vector<ParameterLine> lines = parameterLines(limit, {});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].interval, "");
  EXPECT_EQ(lines[0].remark, "these recordings hardly determine it");
  EXPECT_EQ(lines[1].value, "42 % of full scale per second");
  EXPECT_EQ(lines[1].interval, "37 to 49 % of full scale per second");
  EXPECT_EQ(claimSentences({limit}, {}).front(),
            "The pressure of muscle 0 rises or falls too slowly: at most 42 % of full scale per second (venting).");
}

/// The usual range of this damping is 20 to 3000 N s/m, so 245 N s/m is the middle by factors.
TEST(EffectWords, GivesNoNumberThatMayBeAnything) {
  const auto damping = [](double value, double low, double high) {
    return FoundEffect{"viscous_loss", "all", 1, {{"damping_Ns_per_m", {value, low, high}}}};
  };
  const auto isSaid = [&](const FoundEffect& effect) { return claimSentences({effect}, {}).front().find(':') != std::string::npos; };
  EXPECT_FALSE(isSaid(damping(49, 0, 1267)));
  EXPECT_EQ(parameterLines(damping(49, 0, 1267), {}).front().remark, "these recordings hardly determine it");
  EXPECT_TRUE(isSaid(damping(49, 0, 200)));
  EXPECT_TRUE(isSaid(damping(1400, 800, 2000)));
}

TEST(EffectWords, NamesSignalsAsAReaderWould) {
  EXPECT_EQ(signalTitle("length_0_mm"), "length of muscle 0");
  EXPECT_EQ(signalTitle("force_11_N"), "tension of muscle 11");
  EXPECT_EQ(signalTitle("angle_elbow_deg"), "angle of the elbow joint");
  EXPECT_EQ(signalTitle("angle_upper_arm_2_deg"), "angle of the upper arm 2 joint");
  EXPECT_EQ(signalTitle("hand_x_mm"), "x of the hand");
  EXPECT_EQ(signalUnitWords("pressure_0"), "of full scale");
  EXPECT_EQ(signalUnitWords("angle_elbow_deg"), "deg");
}

TEST(EffectWords, SpeaksOfEffectsThatItDoesNotKnowToo) {
  EXPECT_EQ(effectTitle("own.sticky_valve"), "own.sticky valve");
  EXPECT_EQ(claimSentences({{"own_valve", "muscle_0", 1, {}}}, {}).front(), "Own valve acts on muscle 0.");
}

}  // namespace
}  // namespace musclesim
