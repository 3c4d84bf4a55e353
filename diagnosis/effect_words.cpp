#include "effect_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "musclesim/effect/catalogue.h"
#include "sentences.h"

namespace musclesim {

namespace {

/// How a parameter is said. `{}` stands for the number.
struct ParameterWords {
  const char* name;
  const char* label;
  const char* phrase = "";   ///< in a sentence; empty: not in sentences
  const char* percent = "";  ///< of a share of one: how it is said in percent, such as "% of full scale"
};

/// How an effect is said. `{}` stands for what it acts on.
struct EffectWords {
  const char* id;
  const char* title;
  const char* claim;
  const char* claim_below;  ///< if the first parameter lies below its neutral value; null: the same
  const char* explanation;
  std::vector<ParameterWords> parameters;
};

/// By stage, in the order of the catalogue's page.
const std::vector<EffectWords> effect_words = {
    {"channel_swap",
     "exchanged commands",
     "The commands of {} are exchanged",
     nullptr,
     "Each of the two muscles gets the command that is meant for the other one: two wires or two hoses are exchanged.",
     {}},
    {"command_dead_band",
     "dead band of the valve",
     "Small commands do not open the valve of {}",
     nullptr,
     "Below a threshold the valve stays shut: the pressure stays at zero and nothing moves.",
     {{"threshold", "threshold of the command", "nothing happens below {}", "% of full scale"}}},
    {"command_quantisation",
     "coarse commands",
     "The commands of {} come in coarse steps",
     nullptr,
     "The converter knows only a few levels, so the command jumps from one to the next.",
     {{"bits", "resolution", "{}"}}},
    {"transport_delay",
     "dead time",
     "The pressure of {} comes late",
     nullptr,
     "The command reaches the valve only after some time, as through a bus, a slow loop or a long hose. Its shape is unchanged.",
     {{"delay_s", "dead time", "a dead time of {}"}}},
    {"flow_limit",
     "limited flow",
     "The pressure of {} rises or falls too slowly",
     nullptr,
     "Only so much air passes the valve. After a large step the pressure climbs along a straight ramp; small steps are unchanged.",
     {{"fill_rate_per_s", "fastest rise", "at most {} (filling)", "% of full scale per second"},
      {"vent_rate_per_s", "fastest fall", "at most {} (venting)", "% of full scale per second"},
      {"proportional_band", "distance from the command at which the valve begins to close", "", "% of full scale"}}},
    {"leak",
     "leak",
     "{} loses air",
     nullptr,
     "Air escapes. The regulator, if there is one, replaces it, so the pressure stays somewhat below the command.",
     {{"leak_per_s", "rate of the loss", "a rate of {}"}, {"regulator_time_constant_s", "time constant of the regulator"}}},
    {"pressure_calibration",
     "regulator out of calibration",
     "The pressure of {} is not the one that was asked for",
     nullptr,
     "The regulator's scale is off: the pressure differs from the command by a factor and a constant, also at rest.",
     {{"gain", "factor", "a factor of {}"}, {"offset", "constant", "a constant of {}", "% of full scale"}}},
    {"supply_droop",
     "weak supply",
     "The supply pressure drops while muscles fill",
     nullptr,
     "All muscles share one supply. When they ask for much air at once, its pressure drops and each gets less.",
     {{"droop", "drop per unit of demand", "by {} at full demand", "%"}}},
    {"valve_lag",
     "lag of the valve",
     "The pressure of {} comes late",
     nullptr,
     "Valve and volume need time to fill and to vent: after a step the pressure approaches its new value along a curve.",
     {{"fill_time_constant_s", "time constant while filling", "a lag of {} (filling)"},
      {"vent_time_constant_s", "time constant while venting", "a lag of {} (venting)"},
      {"next_lag_ratio", "ratio of each lag in series to the one before", "", ""}}},
    {"volume_coupling",
     "motion changes the pressure",
     "Stretching {} changes the pressure in it",
     nullptr,
     "Stretching a muscle compresses the air in it faster than the regulator lets it out.",
     {{"polytropic_exponent", "polytropic exponent", "a polytropic exponent of {}"},
      {"regulator_time_constant_s", "time constant of the regulator"},
      {"rest_volume_ratio", "volume at rest over that of the model"}}},
    {"braid_hysteresis",
     "friction in the braid",
     "{} rubs inside",
     nullptr,
     "The threads of the braid rub against each other: the muscle pulls less while it shortens than while it lengthens.",
     {{"relative_width", "half the width of the loop", "a loop of {} to each side", "% of the tension"},
      {"presliding_mm", "motion until the threads slide"},
      {"pressure_share", "share of the friction that follows the pressure", "", "%"}}},
    {"creep",
     "creep",
     "{} yields slowly under load",
     nullptr,
     "Rubber goes on yielding after the fast change: the length drifts while the pressure is constant.",
     {{"amount", "slow change", "by {}", "% of the immediate change"},
      {"time_constant_s", "time constant", "within about {}"},
      {"spread_decades", "spread of the time constants"}}},
    {"force_drift",
     "drift of the force",
     "The tension of {} drifts",
     nullptr,
     "Warmth or wear change the tension steadily over minutes.",
     {{"rate_per_min", "change per minute", "by {} per minute", "%"}}},
    {"force_gain",
     "other strength",
     "{} is stronger than in the model",
     "{} is weaker than in the model",
     "The tension is off by a factor in both directions: ageing, or another type of muscle.",
     {{"gain", "factor on the tension", "a factor of {}"}}},
    {"length_offset",
     "mounted too long or too short",
     "{} is stretched more than in the model",
     "{} is stretched less than in the model",
     "The muscle is mounted at another length than in the model, so it stands elsewhere on its curve of tension over length.",
     {{"offset_mm", "stretched more by", "by {}"}}},
    {"force_law",
     "other force law",
     "{} follows another force law than in the model",
     nullptr,
     "The tension at rest depends on pressure and length in another way than in the model, the same in both directions.",
     {{"law", "law"}, {"rest_length_mm", "rest length of the law"}}},
    {"series_elasticity",
     "elastic tendon",
     "{} pulls through an elastic tendon",
     nullptr,
     "Something between muscle and bone yields, so the joint is softer.",
     {{"stiffness_N_per_mm", "stiffness", "a stiffness of {}"}}},
    {"threshold_pressure",
     "threshold of the bladder",
     "{} needs some pressure before it pulls",
     nullptr,
     "The bladder must first be pressed against the braid. Below the threshold there is hardly any tension.",
     {{"threshold", "threshold pressure", "{}", "% of full scale"}, {"softness", "width of the kink over the threshold"}}},
    {"viscous_loss",
     "damping in the muscle",
     "{} resists fast changes of its length",
     nullptr,
     "The faster the muscle changes its length, the more it resists.",
     {{"damping_Ns_per_m", "damping", "a damping of {}"}, {"shortening_ratio", "damping while shortening over that while lengthening"}}},
    {"attachment_offset",
     "shifted attachment",
     "{} is attached at another place than in the model",
     nullptr,
     "One end of the muscle sits elsewhere, so its length and its lever are wrong together, depending on the angle.",
     {{"offset_mm", "shift along the lever", "{} along the lever"}, {"rise_mm", "shift upward", "{} upward"}}},
    {"base_tilt",
     "tilted base",
     "The robot does not stand upright",
     nullptr,
     "The base is tilted, so gravity pulls in another direction than in the model.",
     {{"tilt_x_deg", "tilt about x", "{} about x"}, {"tilt_z_deg", "tilt about z", "{} about z"}}},
    {"contact",
     "contact",
     "{} meets an obstacle",
     nullptr,
     "A wall or a cable stops the motion on one side.",
     {{"stiffness_Nm_per_deg", "stiffness", "a stiffness of {}"},
      {"stiffness_N_per_mm", "stiffness", "a stiffness of {}"},
      {"plane_deg", "place", "from {} on"},
      {"plane_mm", "place", "from {} on"}}},
    {"external_force",
     "constant force",
     "A constant force acts on {}",
     nullptr,
     "Something pulls or pushes all the time, such as a cable or a spring. (On the rig, the hand is the load.)",
     {{"force_x_N", "to the side", "{} to the side"},
      {"force_y_N", "upward", "{} upward"},
      {"force_z_N", "to the front", "{} to the front"}}},
    {"joint_coulomb_friction",
     "dry friction in a joint",
     "{} has dry friction",
     nullptr,
     "The joint resists with the same torque at any speed, and sticks where the motion turns round.",
     {{"torque_Nm", "torque", "a torque of {}"}, {"presliding_deg", "motion until it slides"}}},
    {"joint_stiffness",
     "stiff joint",
     "Something pulls {} back to a rest angle",
     nullptr,
     "Hoses and cables act like a spring on the joint.",
     {{"stiffness_Nm_per_rad", "stiffness", "a stiffness of {}"}, {"rest_deg", "rest angle"}}},
    {"joint_stop_offset",
     "shifted stops",
     "The stops of {} sit elsewhere than in the model",
     nullptr,
     "The joint ends at other angles than in the model. The gap appears only near the stops.",
     {{"offset_deg", "shift", "by {}"}}},
    {"joint_viscous_friction",
     "damped joint",
     "{} is damped",
     nullptr,
     "The faster the joint turns, the more it resists.",
     {{"damping_Nms_per_rad", "damping", "a damping of {}"}}},
    {"payload",
     "other load",
     "{} carries more than in the model",
     "{} carries less than in the model",
     "The mass is not the one of the model: its weight and its inertia are off together. (On the rig, the hand is the load.)",
     {{"mass_kg", "additional mass", "by {}"}}},
    {"sensor_backlash",
     "play of a sensor",
     "The sensor of {} has play",
     nullptr,
     "The reading stands still after each turn of the motion until the play is used up. The true motion is right.",
     {{"width_deg", "play", "{}"}, {"width_mm", "play", "{}"}}},
    {"sensor_bias",
     "offset of a sensor",
     "The reading of {} is off by a constant",
     nullptr,
     "The sensor's zero is wrong. The true motion is right.",
     {{"offset", "constant", "{}"}}},
    {"sensor_delay",
     "late reading",
     "The reading of {} comes late",
     nullptr,
     "The sensor or its filter is slow. The true motion is right.",
     {{"delay_s", "delay", "{}"}, {"filter_share", "share of the delay that comes from a filter", "", "%"}}},
    {"sensor_dropout",
     "lost samples",
     "Samples of {} are lost",
     nullptr,
     "Some samples never arrive; the reading keeps its last value.",
     {{"fraction", "share of the samples", "{}", "%"}, {"mean_gap_samples", "samples lost in a row, on average"}}},
    {"sensor_gain",
     "scale of a sensor",
     "The reading of {} is too large",
     "The reading of {} is too small",
     "The sensor's scale is wrong: the error is proportional to the reading. The true motion is right.",
     {{"gain", "factor", "a factor of {}"}}},
    {"slow_clock",
     "slow clock",
     "The reading of {} falls ever further behind",
     nullptr,
     "The clock that wrote this column runs slower than the one that wrote the commands. The true motion is right.",
     {{"lag_per_s", "lag that grows with the time", "by {}", "% of the time"}}}};

const EffectWords* wordsOfEffect(const std::string& id) {
  const auto found = std::ranges::find_if(effect_words, [&](const EffectWords& words) { return id == words.id; });
  return found == effect_words.end() ? nullptr : &*found;
}

ParameterWords wordsOfParameter(const std::string& id, const EffectParameter& parameter) {
  if (const EffectWords* words = wordsOfEffect(id))
    for (const ParameterWords& one : words->parameters)
      if (parameter.name == one.name) return one;
  return {parameter.name.c_str(), parameter.name.c_str()};
}

std::string spaced(std::string words) {
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string idOf(const std::string& label) {
  return label.substr(0, label.find('@'));
}

std::string componentOf(const std::string& label) {
  return label.substr(label.find('@') + 1);
}

/// Text with `{}` replaced.
std::string filled(std::string text, const std::string& word) {
  if (const auto at = text.find("{}"); at != std::string::npos) text.replace(at, 2, word);
  return text;
}

/// "a, b and c".
std::string listed(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

}  // namespace

std::string capitalised(std::string words) {
  if (!words.empty()) words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words;
}

std::string effectTitle(const std::string& id) {
  const EffectWords* words = wordsOfEffect(id);
  return words ? words->title : spaced(id);
}

std::string effectTitleOn(const std::string& label) {
  const std::string id = idOf(label);
  return effectTitle(id) + " (" + ownerWords(id, componentOf(label)) + ")";
}

std::string effectExplanation(const std::string& id) {
  if (const EffectWords* words = wordsOfEffect(id)) return words->explanation;
  for (const EffectInfo& info : effectCatalogue())
    if (info.id == id) return capitalised(info.summary) + ".";
  return "";
}

std::string signalTitle(const std::string& signal) {
  const auto second = signal.find('_');
  if (second == std::string::npos) return signal;
  const std::string quantity = signal.substr(0, second);
  std::string which = signal.substr(second + 1);
  which = which.substr(0, which.find('_'));
  if (quantity == "angle") return "angle of the " + which + " joint";
  if (quantity == "hand") return which + " of the hand";
  if (quantity == "command" || quantity == "pressure" || quantity == "length" || quantity == "force")
    return (quantity == "force" ? "tension" : quantity) + " of muscle " + which;
  return spaced(signal);
}

std::string signalUnitWords(const std::string& signal) {
  if (signal.starts_with("pressure_") || signal.starts_with("command_")) return "of full scale";
  const auto first = signal.find('_'), last = signal.rfind('_');
  return first == last ? "" : signal.substr(last + 1);
}

std::string ownerWords(const std::string& id, const std::string& component) {
  const bool is_sensor = id.starts_with("sensor_"), is_joint = id.starts_with("joint_");
  if (component == "all") return is_sensor ? "every sensor" : is_joint ? "every joint" : "every muscle";
  if (component.starts_with("joint_")) return "the " + spaced(component.substr(6)) + " joint";
  if (component.starts_with("signal_")) return "the " + signalTitle(component.substr(7));
  if (component == "hand" || component == "base") return "the " + component;
  if (const auto plus = component.find('+'); plus != std::string::npos)
    return spaced(component.substr(0, plus)) + " and " + spaced(component.substr(plus + 1));
  return spaced(component);
}

namespace {

/// A number with its unit as it is said: seconds below one as ms, shares in percent.
struct Said {
  double factor = 1;
  std::string unit;
};

Said howToSay(const ParameterWords& words, const EffectParameter& parameter, double value, const std::string& reading_unit) {
  if (*words.percent) return {100, words.percent};
  if (parameter.unit == "s" && std::abs(value) < 1) return {1000, "ms"};
  if (parameter.unit == "1/s") return {1, "per second"};
  if (parameter.unit == "unit of the signal") return reading_unit == "of full scale" ? Said{100, "% of full scale"} : Said{1, reading_unit};
  return {1, parameter.unit};
}

/// As many decimals as the interval justifies, three digits without one.
std::string digits(double value, double half) {
  constexpr int most_decimals = 6;
  if (!(half > 0)) return fmt::format("{:.3g}", value);
  const int power = static_cast<int>(std::floor(std::log10(half)));
  const int decimals = (half < 2 * std::pow(10, power) ? 1 : 0) - power;
  return decimals > most_decimals ? fmt::format("{:.3g}", value) : fmt::format("{:.{}f}", value, std::max(0, decimals));
}

/// At most three digits, fewer if the interval justifies no more.
std::string fewDigits(double value, double half) {
  constexpr int most = 3;
  int count = most;
  if (half > 0 && value != 0) {
    const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(half))));
    count = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1 + decimals, 1, most);
  }
  return fmt::format("{:.{}g}", value, count);
}

double usualWidth(const EffectParameter& parameter) {
  const double width = parameter.usual_high - parameter.usual_low;
  return std::isfinite(width) ? width : 0;
}

/// An interval says something if it is narrower than what is known without any recording; of a parameter that only says how something
/// acts, clearly narrower.
bool saysSomething(const Estimate& estimate, const EffectParameter& parameter) {
  constexpr double clearly = 0.8;
  if (!estimate.is_determined || !std::isfinite(estimate.low) || !std::isfinite(estimate.high) || estimate.low >= estimate.high)
    return false;
  const double known = std::max(usualWidth(parameter), std::abs(estimate.value));
  return estimate.high - estimate.low <= (parameter.shape ? clearly * known : known);
}

/// Whether the parameter changes nothing, or only says how something acts and is not known.
bool doesNothing(const Estimate& estimate, const EffectParameter& parameter) {
  if (!std::isfinite(estimate.value) || isLeftOut(estimate)) return true;
  if (parameter.shape) return !saysSomething(estimate, parameter) || estimate.value == parameter.neutral;
  return estimate.value == parameter.neutral;
}

std::string remarkFor(const Estimate& estimate, const EffectParameter& parameter, const Said& said) {
  const auto limited = [&](double bound) { return std::isfinite(bound) && estimate.value == bound && bound != parameter.neutral; };
  if (limited(parameter.minimum) || limited(parameter.maximum)) return "at its bound";
  if (estimate.low < estimate.high && !saysSomething(estimate, parameter)) return "these recordings hardly determine it";
  if (!estimate.is_determined) return "these recordings do not determine it";
  if (estimate.value >= parameter.usual_low && estimate.value <= parameter.usual_high) return "";
  return fmt::format("usual range {:.4g} to {:.4g} {}", said.factor * parameter.usual_low, said.factor * parameter.usual_high, said.unit);
}

std::string readingUnit(const FoundEffect& effect, const std::vector<std::string>& signals) {
  if (!effect.component.starts_with("signal_")) return "";
  const std::string name = effect.component.substr(7);
  for (const std::string& signal : signals)
    if (signal == name || signal.starts_with(name + "_")) return signalUnitWords(signal);
  return "";
}

/// The catalogue's parameters of an effect; none for one that the catalogue does not have.
std::vector<EffectParameter> parametersOf(const std::string& id) {
  for (const EffectInfo& info : effectCatalogue())
    if (info.id == id) return info.parameters;
  return {};
}

}  // namespace

std::vector<ParameterLine> parameterLines(const FoundEffect& effect, const std::vector<std::string>& signals) {
  std::vector<ParameterLine> lines;
  for (const EffectParameter& parameter : parametersOf(effect.id)) {
    const ParameterWords words = wordsOfParameter(effect.id, parameter);
    if (const auto choice = effect.choices.find(parameter.name); choice != effect.choices.end())
      lines.push_back({spaced(words.label), choice->second, "", ""});
    const auto found = effect.parameters.find(parameter.name);
    if (found == effect.parameters.end() || doesNothing(found->second, parameter)) continue;
    const Estimate& estimate = found->second;
    const Said said = howToSay(words, parameter, estimate.value, readingUnit(effect, signals));
    const bool with_interval = saysSomething(estimate, parameter);
    const double half = with_interval ? said.factor * (estimate.high - estimate.low) / 2 : 0;
    auto number = [&](double value) { return digits(said.factor * value, half); };
    const std::string unit = said.unit.empty() ? "" : " " + said.unit;
    if (number(estimate.value).find_first_of("123456789") == std::string::npos) continue;  // too small to be told
    lines.push_back({spaced(words.label), number(estimate.value) + unit,
                     with_interval ? fmt::format("{} to {}{}", number(estimate.low), number(estimate.high), unit) : "",
                     remarkFor(estimate, parameter, said)});
  }
  return lines;
}

namespace {

/// "a lag of 40 ms (filling) and 70 ms (venting)": what consecutive phrases have in common before the number is said once.
std::string numbersOf(const FoundEffect& effect, const std::vector<std::string>& signals) {
  std::vector<std::string> words;
  std::string before;
  for (const EffectParameter& parameter : parametersOf(effect.id)) {
    const ParameterWords said = wordsOfParameter(effect.id, parameter);
    const auto found = effect.parameters.find(parameter.name);
    if (!*said.phrase || found == effect.parameters.end() || doesNothing(found->second, parameter)) continue;
    const Estimate& estimate = found->second;
    if (!saysSomething(estimate, parameter) && estimate.low < estimate.high) continue;
    const Said how = howToSay(said, parameter, estimate.value, readingUnit(effect, signals));
    std::string phrase = said.phrase;
    const std::string lead = phrase.substr(0, phrase.find("{}"));
    if (lead == before) phrase = phrase.substr(lead.size());
    before = lead;
    words.push_back(filled(phrase, fewDigits(how.factor * estimate.value, how.factor * (estimate.high - estimate.low) / 2) +
                                       (how.unit.empty() ? "" : " " + how.unit)));
  }
  return listed(words);
}

/// "The pressure of muscle 1 comes late"; a weaker or stronger word by the side of the first parameter.
std::string claimOf(const FoundEffect& effect) {
  const EffectWords* words = wordsOfEffect(effect.id);
  if (!words) return capitalised(effectTitle(effect.id)) + " acts on " + ownerWords(effect.id, effect.component);
  const std::vector<EffectParameter> parameters = parametersOf(effect.id);
  bool is_below = false;
  if (words->claim_below && !parameters.empty())
    if (const auto first = effect.parameters.find(parameters.front().name); first != effect.parameters.end())
      is_below = first->second.value < parameters.front().neutral;
  return capitalised(filled(is_below ? words->claim_below : words->claim, ownerWords(effect.id, effect.component)));
}

}  // namespace

std::vector<std::string> claimSentences(const std::vector<FoundEffect>& effects, const std::vector<std::string>& signals) {
  std::vector<std::pair<std::string, std::vector<std::string>>> claims;
  for (const FoundEffect& effect : effects) {
    const std::string claim = claimOf(effect);
    auto same = std::ranges::find(claims, claim, &std::pair<std::string, std::vector<std::string>>::first);
    if (same == claims.end()) same = claims.insert(claims.end(), {claim, {}});
    if (const std::string numbers = numbersOf(effect, signals); !numbers.empty()) same->second.push_back(numbers);
  }
  std::vector<std::string> sentences;
  for (const auto& [claim, numbers] : claims) sentences.push_back(claim + (numbers.empty() ? "" : ": " + listed(numbers)) + ".");
  return sentences;
}

}  // namespace musclesim
