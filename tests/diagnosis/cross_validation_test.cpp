// Fitted hypotheses are judged by recordings that their parameters were not fitted to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "musclesim/diagnosis/diagnosis.h"
#include "planted.h"

namespace musclesim {
namespace {

using planted::few;
using planted::recorded;

/// The trial with that effect alone.
const Trial& trialOf(const Diagnosis& diagnosis, const std::string& label) {
  return *std::ranges::find(diagnosis.trials, std::vector<std::string>{label}, &Trial::effects);
}

/// ln of the cross-validated RMS residual over the fitted one, summed over all blocks.
double lostUnseen(const Trial& trial) {
  double sum = 0;
  for (std::size_t i = 0; i < trial.rms.size(); ++i) sum += std::log(trial.rms_cross_validated.at(i) / trial.rms[i]);
  return sum;
}

TEST(CrossValidation, JudgesByRecordingsThatTheNumbersWereNotFittedTo) {
  // The scale of the force is 10 % off in one recording and 20 % in the other: no number fits both.
  auto scaled = [](double gain, double amplitude, std::uint64_t seed) {
    return recorded({{"force_gain", "muscle_0", {{"gain", gain}}}}, amplitude, seed);
  };
  const DiagnosisOptions options = few({"force_gain"});
  const Diagnosis same = diagnose({scaled(0.85, 0.15, 1), scaled(0.85, 0.1, 3), scaled(0.85, 0.2, 2)}, options),
                  different = diagnose({scaled(0.9, 0.15, 1), scaled(0.8, 0.1, 3), scaled(0.9, 0.2, 2)}, options);
  EXPECT_NEAR(lostUnseen(trialOf(same, "force_gain@muscle_0")), 0, 0.1);
  EXPECT_GT(lostUnseen(trialOf(different, "force_gain@muscle_0")), 1);
}

TEST(CrossValidation, OneRecordingAndItsRepeatAreSeenTogether) {
  const std::vector<ActiveEffect> heavy = {{"payload", "hand", {{"mass_kg", 0.2}}}};
  const Diagnosis found = diagnose({recorded(heavy, 0.15, 1), recorded(heavy, 0.15, 3), recorded(heavy, 0.2, 2)}, few({"payload"}));
  EXPECT_TRUE(trialOf(found, "payload@hand").rms_cross_validated.empty());
}

}  // namespace
}  // namespace musclesim
