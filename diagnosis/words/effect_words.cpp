#include "effect_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "effect_words_table.h"
#include "musclesim/effect/catalogue.h"
#include "sentences.h"

namespace musclesim {

namespace {

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

}  // namespace

std::string listed(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

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
  if (quantity == "angle") return "angle of the " + spaced(which.substr(0, which.rfind("_deg"))) + " joint";
  which = which.substr(0, which.find('_'));
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
  const bool is_slide = id.starts_with("slide_");
  if (component == "all") return is_sensor ? "every sensor" : is_joint ? "every joint" : is_slide ? "every slide" : "every muscle";
  if (component.starts_with("joint_")) return "the " + spaced(component.substr(6)) + " joint";
  if (component.starts_with("slide_")) return "the load on the " + spaced(component.substr(6));
  if (component.starts_with("signal_")) return "the " + signalTitle(component.substr(7));
  if (component == "hand" || component == "base") return "the " + component;
  if (const auto plus = component.find('+'); plus != std::string::npos)
    return spaced(component.substr(0, plus)) + " and " + spaced(component.substr(plus + 1));
  return spaced(component);
}

double usualScale(const EffectParameter& parameter) {
  const double low = parameter.usual_low, high = parameter.usual_high, scale = low > 0 ? std::sqrt(low * high) : (high - low) / 2;
  return std::isfinite(scale) ? scale : 0;
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
  return decimals > most_decimals ? fmt::format("{:.3g}", value) : roundedWords(value, std::max(0, decimals));
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

/// An interval says something if it is no wider than the usual scale or than plus and minus the value; of a parameter that only says how
/// something acts, than the value.
bool saysSomething(const Estimate& estimate, const EffectParameter& parameter) {
  if (!estimate.is_determined || !std::isfinite(estimate.low) || !std::isfinite(estimate.high) || estimate.low >= estimate.high)
    return false;
  const double value = std::abs(estimate.value);
  return estimate.high - estimate.low <= std::max(usualScale(parameter), parameter.shape ? value : 2 * value);
}

/// Whether the parameter changes nothing, or only says how something acts and is not known.
bool doesNothing(const Estimate& estimate, const EffectParameter& parameter) {
  if (!std::isfinite(estimate.value) || isLeftOut(estimate)) return true;
  if (parameter.shape) return !saysSomething(estimate, parameter) || estimate.value == parameter.neutral;
  return estimate.value == parameter.neutral;
}

/// `is_correction`: the number is added to another one, so that its own usual range says nothing.
std::string remarkFor(const Estimate& estimate, const EffectParameter& parameter, const Said& said, bool is_correction) {
  const auto limited = [&](double bound) { return std::isfinite(bound) && estimate.value == bound && bound != parameter.neutral; };
  if (limited(parameter.minimum) || limited(parameter.maximum)) return "at its bound";
  if (estimate.low < estimate.high && !saysSomething(estimate, parameter)) return "these recordings hardly determine it";
  if (parameter.shape && estimate.value == estimate.low && estimate.low < estimate.high && estimate.value != parameter.neutral)
    return "the smallest that was tried";
  if (!estimate.is_determined) return "these recordings do not determine it";
  if (is_correction || (estimate.value >= parameter.usual_low && estimate.value <= parameter.usual_high)) return "";
  return fmt::format("usual range {:.4g} to {:.4g} {}", said.factor * parameter.usual_low, said.factor * parameter.usual_high, said.unit);
}

/// A weak effect is nothing unusual; a strong one, or one of an unusual kind, may stand for something else. So may one whose strength is
/// nearly a constant of nature, such as a polytropic exponent, but is not that constant. Shapes that may lie on either side of 0, such as
/// the place of a wall, have no usual value (as in Hypothesis::excess).
bool isBeyond(double value, const EffectParameter& parameter) {
  constexpr double narrow = 2;  // upper over lower end of the usual strengths
  if (parameter.unit == "unit of the signal" || (parameter.shape && !(parameter.usual_low > 0))) return false;
  const bool is_narrow = parameter.usual_low > parameter.neutral &&
                         parameter.usual_high - parameter.neutral < narrow * (parameter.usual_low - parameter.neutral);
  const bool both_ends = parameter.shape || is_narrow;
  return value < (both_ends ? parameter.usual_low : std::min(parameter.usual_low, parameter.neutral)) ||
         value > (both_ends ? parameter.usual_high : std::max(parameter.usual_high, parameter.neutral));
}

std::string readingUnit(const FoundEffect& effect, const std::vector<std::string>& signals) {
  if (!effect.component.starts_with("signal_")) return "";
  const std::string name = effect.component.substr(7);
  for (const std::string& signal : signals)
    if (signal == name || signal.starts_with(name + "_")) return signalUnitWords(signal);
  return "";
}

/// Whether the effect's numbers are added to those of the model.
bool isCorrection(const FoundEffect& effect) {
  return std::ranges::any_of(effect.choices, [](const auto& choice) { return choice.second == "corrected"; });
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
                     remarkFor(estimate, parameter, said, isCorrection(effect)),
                     !isCorrection(effect) && isBeyond(estimate.value, parameter)});
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

bool holdsOnUnseenData(const FoundEffect& effect) {
  constexpr double nothing_percent = 1;  // of the gap
  return effect.removes_percent.value_or(0) > -nothing_percent;
}

std::vector<std::string> claimSentences(const std::vector<FoundEffect>& effects, const std::vector<std::string>& signals) {
  struct Claim {
    std::string words;
    std::vector<std::string> numbers = {};
    double probability = 1;  ///< the least of its effects
    bool holds = true;       ///< on the data that were not used for fitting
  };
  std::vector<Claim> claims;
  for (const FoundEffect& effect : effects) {
    const std::string words = claimOf(effect);
    auto same = std::ranges::find(claims, words, &Claim::words);
    if (same == claims.end()) same = claims.insert(claims.end(), {words});
    if (const std::string numbers = numbersOf(effect, signals); !numbers.empty()) same->numbers.push_back(numbers);
    same->probability = std::min(same->probability, effect.probability);
    same->holds = same->holds && holdsOnUnseenData(effect);
  }
  std::vector<std::string> sentences;
  for (const Claim& claim : claims)
    sentences.push_back(claim.words + (claim.numbers.empty() ? "" : ": " + listed(claim.numbers)) +
                        (claim.probability < nearly_sure ? fmt::format(" ({} likely)", probabilityWords(claim.probability)) : "") +
                        (claim.holds ? "." : ". On the data not used for fitting the gap is larger with it."));
  return sentences;
}

}  // namespace musclesim
