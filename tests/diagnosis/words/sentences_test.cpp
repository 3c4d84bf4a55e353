// The sentences of a diagnosis.
#include "diagnosis/words/sentences.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/support.h"

namespace musclesim {
namespace {

Diagnosis lagFound() {
  Diagnosis d;
  d.verdict = Verdict::effects_found;
  d.where = {{"pressure", "muscle_1", "venting", 0.81}};
  d.effects = {{"valve_lag", "muscle_1", 0.931, {{"vent_time_constant_s", {0.081, 0.077, 0.085}}}, 96.2}};
  d.chosen = {"valve_lag@muscle_1"};
  d.explanations = {{d.chosen, 0.931}};
  d.ambiguity_set = d.alternatives = {"valve_lag@muscle_1", "flow_limit@muscle_1"};
  d.reduction_percent = 96.2;
  d.reduction_low_percent = 94;
  d.reduction_high_percent = 97.5;
  return d;
}

TEST(VerdictSentence, SaysWhereWhichHowFarAndWhatElse) {
  const std::string text = verdictSentence(lagFound());
  for (const char* part : {"The gap arises in the pressure stage (muscle 1, 81 % likely), mostly while venting", "93 % likely",
                           "valve lag on muscle 1 with vent_time_constant_s = 0.081 (0.077 to 0.085)", "96.2 % (94.0 to 97.5)",
                           "Less likely, but possible: flow limit on muscle 1"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

TEST(VerdictSentence, DoesNotNameAStageThatIsHardlyAheadOfTheNext) {
  Diagnosis d = lagFound();
  d.where = {{"pressure", "muscle_1", "", 0.27}, {"sensor", "signal_pressure_1", "", 0.26}, {"command", "all", "", 0.25}};
  EXPECT_EQ(whereSentence(d),
            "These signals do not show at which stage the gap arises; the most likely are pressure (muscle 1, 27 %) and sensor (signal "
            "pressure 1, 26 %)");
}

TEST(VerdictSentence, SaysWhereSignalsSpeakAgainstWhatTheGapLooksLike) {
  Diagnosis d = lagFound();
  d.where = {{"body", "hand", "", 0.9, true}, {"force", "muscle_0", "", 0.1}};
  EXPECT_FALSE(isLocated(d.where));
  EXPECT_EQ(
      whereSentence(d),
      "The shape of the gap favours the body stage (hand, 90 %), although the signals contradict it; the signals do not rule out force");
}

TEST(VerdictSentence, NamesNumbersThatMayBeTheCauseInstead) {
  Diagnosis d = lagFound();
  EXPECT_EQ(caveatsOf(d).instead, "");
  d.numbers_instead = {{"leg.foot_kg", "kg", 1, 1.1484, {"payload@hand"}},
                       {"leg.lever_mm", "mm", 30, 27, {"payload@hand"}},
                       {"leg.ratio", "", 0.5, 0.45, {"joint_stop_offset@joint_knee", "creep@all"}}};
  EXPECT_EQ(caveatsOf(d).instead,
            "Numbers that were taken as exact may be the cause instead: leg.foot_kg = 1.148 kg (given as 1) or leg.lever_mm = 27 mm (given "
            "as 30) would do what payload on hand does; leg.ratio = 0.45 (given as 0.5) would do what joint stop offset on joint knee "
            "together with creep on all components do. Give those that are not known so well a parameter_tolerance in the sidecar.");
  EXPECT_TRUE(contains(verdictSentence(d), caveatsOf(d).instead));
}

TEST(VerdictSentence, ConfirmsNothingOnDataWithoutAGap) {
  Diagnosis d = lagFound();
  d.verdict = Verdict::unexplained;
  d.held_out_is_noise = true;
  EXPECT_TRUE(contains(verdictSentence(d), "but the held-out data does not")) << verdictSentence(d);
  d.held_out_is_noise = false;
  EXPECT_TRUE(contains(verdictSentence(d), "There is a gap that I cannot explain")) << verdictSentence(d);
}

TEST(VerdictSentence, TellsWhatSignalsShowFromWhatTheGapLooksLike) {
  Diagnosis d = lagFound();
  d.chosen.clear();
  d.where = {{"force", "muscle_0", "", 0.95}, {"body", "hand", "", 0.04}, {"sensor", "all", "", 0.01}, {"pressure", "all", "", 0, true}};
  EXPECT_EQ(whereSentence(d), "The shape of the gap favours the force stage (muscle 0, 95 %); the signals do not rule out body or sensor");
  for (std::size_t i = 1; i < d.where.size(); ++i) d.where[i].is_ruled_out = true;
  EXPECT_EQ(whereSentence(d), "The gap arises in the force stage (muscle 0, 95 % likely)");
  EXPECT_TRUE(mayBeAt(d.where, "force"));
  EXPECT_FALSE(mayBeAt(d.where, "body"));
  d.where = {
      {"sensor", "all", "", 0.6}, {"force", "all", "", 0.2}, {"body", "all", "", 0.2}, {"command", "all", ""}, {"pressure", "all", ""}};
  EXPECT_EQ(whereSentence(d),
            "The shape of the gap favours the sensor stage (all components, 60 %); the signals do not rule out any other stage");
  d.where = {{"pressure", "muscle_1", "venting", 0.81}, {"command", "all", "", 0.15}, {"force", "all", "", 0.04, true}};
  EXPECT_EQ(whereSentence(d),
            "The gap arises before the force stage, in command or pressure (muscle 1; its shape favours pressure, 81 % likely), mostly "
            "while venting");
  EXPECT_TRUE(mayBeAt(d.where, "pressure"));
  EXPECT_TRUE(mayBeAt(d.where, "command"));
  EXPECT_FALSE(mayBeAt(d.where, "force"));
}

TEST(VerdictSentence, NamesAPhaseOnlyWhereTheHeldOutDataAgrees) {
  Diagnosis d = lagFound();
  d.phases = {{"filling", 5, 1}, {"venting", 9, 1}};
  EXPECT_TRUE(contains(whereSentence(d), "mostly while venting"));
  d.phases[0].before = 10;
  EXPECT_FALSE(contains(whereSentence(d), "mostly while"));
}

TEST(VerdictSentence, LeavesOutWhatSaysNothing) {
  Diagnosis d = lagFound();
  d.effects.front().parameters["fill_time_constant_s"] = {};
  d.reduction_percent = 99.99;
  d.reduction_low_percent = 99.97;
  d.reduction_high_percent = 100;
  const std::string text = verdictSentence(d);
  EXPECT_FALSE(contains(text, "fill_time_constant_s")) << text;
  EXPECT_TRUE(contains(text, "more than 99.9 % of the gap")) << text;
  EXPECT_EQ(elsewhereSentence({99.99, 99.97, 100}), "On another recording of this plant the same is expected.");
  EXPECT_EQ(elsewhereSentence({96.2, 94, 97.5}),
            "On another recording of this plant, 94.0 to 97.5 % is expected to be removed (95 % interval).");
  EXPECT_EQ(effectSentence(d.effects.front()), "valve_lag@muscle_1: vent_time_constant_s = 0.081 (0.077 to 0.085)");
}

TEST(VerdictSentence, GivesNoIntervalThatTellsNothing) {
  Diagnosis d = lagFound();
  d.reduction_low_percent = -1093;
  EXPECT_FALSE(contains(verdictSentence(d), "-1093"));
  EXPECT_TRUE(contains(verdictSentence(d), "removes 96.2 % of the gap"));
  EXPECT_EQ(elsewhereSentence({96.2, -1093, 100}),
            "The recordings are too few or too different to predict how much is removed on another one.");
}

TEST(VerdictSentence, SaysHowLargeAResidualIsThatStandsOut) {
  Diagnosis d = lagFound();
  d.after.normalised = 2;
  EXPECT_FALSE(contains(verdictSentence(d), "The residual is"));
  d.after.normalised = 24;
  EXPECT_TRUE(contains(verdictSentence(d), "The residual is still 5.0 times the noise:"));
  d.after.per_signal = {{"length_0_mm", {0.2, 0.1}}, {"pressure_0", {0.018, 0.002}}};
  EXPECT_TRUE(contains(verdictSentence(d), "The residual is still 5.0 times the noise (9.0 times in pressure_0):"));
}

TEST(VerdictSentence, GivesAPairTheProbabilityOfThePair) {
  Diagnosis d = lagFound();
  d.effects.push_back({"payload", "hand", 0.55, {{"mass_kg", {0.3, 0.2, 0.4}}}, 10});
  d.chosen = {"valve_lag@muscle_1", "payload@hand"};
  d.explanations = {{d.chosen, 0.55}, {{"valve_lag@muscle_1"}, 0.38}};
  EXPECT_TRUE(contains(verdictSentence(d),
                       "(55 % likely) is valve lag on muscle 1 with vent_time_constant_s = 0.081 (0.077 to 0.085) together with payload on "
                       "hand with mass_kg = 0.30 (0.20 to 0.40); adding them to the model removes"));
}

TEST(VerdictSentence, SaysWhetherTheExperimentTellsAllApart) {
  Diagnosis d = lagFound();
  d.next_experiment.commands = {{0.5}};
  d.next_experiment.separates = d.ambiguity_set;
  d.next_experiment.difference = 3.2;
  EXPECT_TRUE(contains(verdictSentence(d), "record the schedule in next.csv to tell them apart."));
  d.next_experiment.difference = 0.7;
  EXPECT_TRUE(contains(verdictSentence(d), "to tell them apart, although even then they differ by only 0.7 times the noise."));
  d.alternatives.emplace_back("leak@muscle_1");
  EXPECT_TRUE(contains(verdictSentence(d), "to tell valve lag on muscle 1 from flow limit on muscle 1, although"));
  d.next_experiment.separates.emplace_back("leak@muscle_1");
  EXPECT_TRUE(
      contains(verdictSentence(d), "to tell them apart, although even then the two most similar differ by only 0.7 times the noise."));
}

TEST(VerdictSentence, SaysWhereTheMotionIsSensitive) {
  Diagnosis d = lagFound();
  d.unsteady = {"angle_elbow_deg", 6, 0.05};
  EXPECT_FALSE(contains(verdictSentence(d), "sensitive"));
  d.unsteady = {"angle_elbow_deg", 50.4, 0.3};
  EXPECT_TRUE(
      contains(verdictSentence(d),
               "the simulated motion is sensitive: internal steps twice as long move angle_elbow_deg by 50 times the noise, 30 % of "
               "the gap"));
  d.unsteady.by = Unsteady::Change::forces;
  EXPECT_TRUE(contains(verdictSentence(d), "sensitive: muscles that pull 0.1 % harder move angle_elbow_deg"));
}

/// A residual that is no larger than what the step size changes does not speak for another effect.
TEST(VerdictSentence, DoesNotCallAnErrorOfTheStepAnotherEffect) {
  Diagnosis d = lagFound();
  d.after.normalised = 24;
  d.after.per_signal = {{"angle_elbow_deg", {0.5, 0.1}}};
  EXPECT_TRUE(contains(verdictSentence(d), "The residual is still 5.0 times the noise (5.0 times in angle_elbow_deg)"));
  d.remainder.is_within_steps = true;
  EXPECT_FALSE(contains(verdictSentence(d), "still"));
  EXPECT_TRUE(contains(verdictSentence(d),
                       "The residual is 5.0 times the noise (5.0 times in angle_elbow_deg), but no more than internal steps twice as long "
                       "change: it does not speak for another effect."));
}

TEST(VerdictSentence, PlacesOnlyMostOfTheGapWhereACauseActsElsewhere) {
  Diagnosis d = lagFound();
  d.where = {{"pressure", "muscle_1", "", 0.95}, {"body", "hand", "", 0.05, true}};
  EXPECT_TRUE(whereSentence(d).starts_with("The gap arises in the pressure stage")) << whereSentence(d);
  d.chosen.push_back("payload@hand");
  EXPECT_TRUE(whereSentence(d).starts_with("Most of the gap arises in the pressure stage")) << whereSentence(d);
}

TEST(VerdictSentence, NamesOtherSetsInFull) {
  Diagnosis d = lagFound();
  d.chosen = {"valve_lag@muscle_1", "payload@hand"};
  d.alternatives = {"payload@hand + valve_lag@muscle_1", "channel_swap@muscle_0+muscle_1 + leak@muscle_1", "leak@all + payload@hand"};
  EXPECT_TRUE(contains(verdictSentence(d),
                       "Less likely, but possible: channel swap on muscle 0+muscle 1 together with leak on muscle 1; or leak on all "
                       "components together with payload on hand."))
      << verdictSentence(d);
}

TEST(VerdictSentence, DoesNotCallASetLessLikelyThatIsNot) {
  Diagnosis d = lagFound();
  d.chosen = {"valve_lag@muscle_1"};
  d.alternatives = {"valve_lag@muscle_1", "leak@muscle_1"};
  d.explanations = {{{"valve_lag@muscle_1"}, 0.28}, {{"leak@muscle_1"}, 0.29}};
  EXPECT_TRUE(contains(verdictSentence(d), "Also possible: leak on muscle 1.")) << verdictSentence(d);
  d.explanations[1].probability = 0.1;
  EXPECT_TRUE(contains(verdictSentence(d), "Less likely, but possible: leak on muscle 1.")) << verdictSentence(d);
}

TEST(VerdictSentence, CountsWhatItDoesNotName) {
  Diagnosis d = lagFound();
  d.chosen = {"creep@muscle_1", "payload@hand", "valve_lag@muscle_1"};
  d.alternatives = {"creep@muscle_1 + payload@hand + valve_lag@muscle_1", "leak@muscle_1", "creep@muscle_1", "payload@hand",
                    "leak@muscle_1 + payload@hand"};
  const std::string text = verdictSentence(d);
  EXPECT_TRUE(contains(text, "is creep on muscle 1, payload on hand and valve lag on muscle 1 together; adding them")) << text;
  EXPECT_TRUE(contains(text, "Less likely, but possible: leak on muscle 1; or creep on muscle 1; or 2 other explanations.")) << text;
}

TEST(DiagnosisSummary, ListsAllChosenEffectsAndTheSetsBesideThem) {
  Diagnosis d = lagFound();
  d.effects = {{"leak", "muscle_0", 0.6, {}, 5},      {"creep", "muscle_0", 0.55, {}, 5}, {"payload", "hand", 0.5, {}, 5},
               {"valve_lag", "muscle_1", 0.4, {}, 5}, {"base_tilt", "base", 0.2, {}, 5},  {"force_gain", "all", 0.05, {}, 5}};
  d.chosen = {"leak@muscle_0", "creep@muscle_0", "payload@hand", "valve_lag@muscle_1"};
  d.explanations = {{d.chosen, 0.4}, {{"leak@muscle_0", "base_tilt@base"}, 0.2}};
  d.ambiguity_sets = {{"payload@hand", "creep@muscle_0", "leak@muscle_0", "valve_lag@muscle_1"}, {"base_tilt@base", "leak@muscle_0"}};
  const std::string text = diagnosisSummary(d);
  for (const char* line : {"40 %  valve_lag@muscle_1\n", "20 %  base_tilt@base\n", "40 %  payload@hand + creep@muscle_0 + leak@muscle_0 + ",
                           "20 %  base_tilt@base + leak@muscle_0\n"})
    EXPECT_TRUE(contains(text, line)) << line << text;
  EXPECT_FALSE(contains(text, "force_gain"));
}

TEST(VerdictSentence, SaysHowLikelyEffectsOnlyStandInForAnother) {
  Diagnosis d = lagFound();
  d.remainder.probability = 0.5;
  d.none_of_these = 0.09;
  EXPECT_FALSE(contains(verdictSentence(d), "stands in"));
  d.none_of_these = 0.48;
  EXPECT_TRUE(contains(verdictSentence(d),
                       "With a probability of 48 %, this effect only stands in for a cause that is none of the known effects."));
  d.candidates = {"creep", "valve_lag"};
  EXPECT_TRUE(contains(verdictSentence(d), "for a cause that is not among creep, valve_lag; other effects were not considered."));
}

TEST(VerdictSentence, SaysHowLikelyNoneOfTheKnownEffectsIs) {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.none_of_these = 0.09;
  EXPECT_FALSE(contains(verdictSentence(d), "none of the known effects"));
  d.none_of_these = 0.48;
  EXPECT_TRUE(
      contains(verdictSentence(d), "With a probability of 48 %, something acts that is none of the known effects, alone or beside them."));
  d.candidates = {"creep"};
  EXPECT_TRUE(contains(verdictSentence(d), "something acts that is not creep, alone or beside it; other effects were not considered."));
  d.candidates = {"creep", "valve_lag"};
  EXPECT_TRUE(contains(verdictSentence(d), "something acts that is none of creep, valve_lag, alone or beside them; other effects"));
}

TEST(VerdictSentence, SaysWhatAnUnexplainedGapLooksLike) {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  Trace trace{"r4.csv", "pressure_0", {}, {}, {}, {}};
  for (int row = 0; row < 200; ++row) {
    trace.time_s.push_back(0.01 * row);
    trace.measured.push_back(0.5 + 0.02 * std::sin(2 * 3.14159 * 5 * 0.01 * row));
    trace.before.push_back(0.5);
  }
  d.traces = {trace};
  d.before.per_signal = d.after.per_signal = {{"pressure_0", {0.014, 0.002}}, {"length_0_mm", {1, 0.1}}};
  EXPECT_TRUE(contains(verdictSentence(d), "In pressure_0 the residual is mostly a ripple of 5 Hz."));
  d.after.per_signal["pressure_0"].rmse = 0.003;
  EXPECT_FALSE(contains(verdictSentence(d), "ripple"));
}

TEST(VerdictSentence, SaysThatASearchWasInterrupted) {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.partial = true;
  EXPECT_EQ(verdictSentence(d), "There is a gap; the search for its cause was interrupted.");
}

TEST(VerdictSentence, AdmitsWhatItCannotTell) {
  Diagnosis d;
  d.verdict = Verdict::no_gap;
  EXPECT_TRUE(contains(verdictSentence(d), "No gap"));
  d.verdict = Verdict::not_excited;
  EXPECT_TRUE(contains(verdictSentence(d), "cannot tell"));
  d.verdict = Verdict::unexplained;
  EXPECT_TRUE(contains(verdictSentence(d), "cannot explain"));
  d.none_of_these = 0.79;
  EXPECT_TRUE(contains(verdictSentence(d), "With a probability of 79 %, something acts that is none of the known effects"));
  d.effects = lagFound().effects;
  d.effects.front().probability = 0.21;
  EXPECT_TRUE(contains(verdictSentence(d), "valve lag on muscle 1, has a probability of 21 %"));
  d.effects.front().probability = 0.98;
  d.effects.front().reduction_percent = -45;
  EXPECT_TRUE(
      contains(verdictSentence(d),
               "has a probability of 98 % on the recordings that it was fitted to, but removes nothing of the gap on the held-out data"));
  d.nominal_refit_percent = 71;
  EXPECT_TRUE(contains(verdictSentence(d), "without any effect removes 71.0 %"));
}

}  // namespace
TEST(VerdictSentence, SaysWhatReTuningRemovesBesideARejectedExplanation) {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.effects = lagFound().effects;
  d.effects.front().probability = 0.2;
  d.attempt.effects = {"valve_lag@muscle_1"};
  d.attempt.reduction_percent = 97.7;
  d.nominal_refit_percent = 97.6;
  EXPECT_TRUE(contains(verdictSentence(d), "Re-tuning the numbers of the model, without any effect, removes 97.6 %."))
      << verdictSentence(d);
}

TEST(VerdictSentence, BeginsWithTheEffectsThatTheModelHasAlready) {
  Diagnosis d = lagFound();
  d.model_effects = {"creep@all"};
  EXPECT_TRUE(verdictSentence(d).starts_with("The model has ")) << verdictSentence(d);
  EXPECT_TRUE(contains(verdictSentence(d), "--without-active-effects"));
}

}  // namespace musclesim
