/// The words in which the report speaks of effects, components, signals and numbers.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/effect_info.h"

namespace musclesim {

/// "dead time" of "transport_delay"; the id with spaces for an effect that has no words here.
std::string effectTitle(const std::string& id);
/// "dead time (muscle 1)" of "transport_delay@muscle_1".
std::string effectTitleOn(const std::string& label);
/// What the effect is, in one or two sentences for a reader who does not know the machine.
std::string effectExplanation(const std::string& id);

/// "muscle 1", "every muscle", "the elbow joint", "the length of muscle 0": what an effect of this id acts on.
std::string ownerWords(const std::string& id, const std::string& component);
/// "length of muscle 0" of "length_0_mm", "angle of the shoulder 2 joint" of "angle_shoulder_2_deg".
std::string signalTitle(const std::string& signal);
/// "mm" of "length_0_mm", "of full scale" of "pressure_0".
std::string signalUnitWords(const std::string& signal);

/// One parameter of a found effect in words.
struct ParameterLine {
  std::string label;       ///< "lag while filling"
  std::string value;       ///< "40 ms"
  std::string interval;    ///< "38 to 42 ms"; empty if an interval says nothing
  std::string remark;      ///< "usual range 10 to 200 ms", "at its bound", "these recordings hardly determine it"
  bool is_beyond = false;  ///< a strength larger than usual, or a shape outside of its usual range
};
/// The parameters that do something, in the catalogue's order. `signals` are the compared columns, for the units of readings.
std::vector<ParameterLine> parameterLines(const FoundEffect& effect, const std::vector<std::string>& signals);

/// What is known of a number without any recording: the middle of a usual range of positive numbers by factors, which may span orders of
/// magnitude; else half of the range. 0 if there is none.
double usualScale(const EffectParameter& parameter);

/// Probability below which a cause is not claimed without it.
inline constexpr double nearly_sure = 0.8;

/// Whether the gap of the held-out data is not larger with the effect than without it, the others present.
bool holdsOnUnseenData(const FoundEffect& effect);

/// "The pressure of muscle 1 comes late: a dead time of 25 ms and a lag of 40 ms (filling) and 70 ms (venting)." One sentence per
/// component and claim: effects on one component that claim the same share a sentence. A sentence on an effect whose probability is below
/// nearly_sure ends with it: "(38 % likely)". One more sentence follows where an effect does not hold on unseen data.
std::vector<std::string> claimSentences(const std::vector<FoundEffect>& effects, const std::vector<std::string>& signals);

/// "a, b and c".
std::string listed(const std::vector<std::string>& words);
/// The first letter as a capital.
std::string capitalised(std::string words);

}  // namespace musclesim
