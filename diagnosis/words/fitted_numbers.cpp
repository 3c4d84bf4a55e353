#include "fitted_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "number_words.h"

namespace musclesim {

namespace {

constexpr double worth_saying_percent = 5;  ///< of the gap
constexpr double unusual_tolerances = 1;    ///< standard deviations, if the data exclude the given value: two numbers in three are nearer

}  // namespace

bool isExplainedByNumbers(const Diagnosis& d) {
  return d.verdict == Verdict::no_gap && d.reduction_percent > 0 && !fittedNumbersToml(d).empty();
}

std::string numbersWords(const Diagnosis& d) {
  std::vector<std::string> words;
  for (const FittedNumber& number : d.numbers)
    if (std::abs(number.in_tolerances) >= unusual_tolerances && (number.fitted.low > number.start || number.fitted.high < number.start))
      words.push_back(fmt::format("{} = {} instead of {:.4g} {}", number.name, estimateWords(number.fitted), number.start, number.unit));
  if (words.empty()) return "";
  return fmt::format("The data speak for {}.{}", fmt::join(words, " and "),
                     d.chosen.empty() ? "" : " The effects need these numbers: use effects.json with nominal.toml.");
}

std::string fittedNumbersSentence(const Diagnosis& d) {
  if (!d.attempt.effects.empty() || d.reduction_percent < worth_saying_percent || fittedNumbersToml(d).empty()) return "";
  return fmt::format("The numbers of the model alone, fitted within their tolerances (nominal.toml), remove {} of the gap.",
                     percentWords(d.reduction_percent));
}

std::string retunedSentence(const Diagnosis& d) {
  if (d.nominal_refit_percent < worth_saying_percent) return "";
  return fmt::format("Re-tuning the numbers of the model, without any effect, removes {}.", percentWords(d.nominal_refit_percent));
}

std::string fittedNumbersToml(const Diagnosis& diagnosis) {
  if (diagnosis.tuned.empty() && diagnosis.numbers.empty()) return "";
  std::string text = fmt::format("# Numbers of the model that musclesim diagnose fitted to recordings, {}.\n",
                                 !diagnosis.chosen.empty()           ? "together with the effects in effects.json"
                                 : diagnosis.attempt.effects.empty() ? "without any effect"
                                                                     : "together with the effects in attempt.json");
  const auto add = [&](const auto& number, const Estimate& fitted) {
    text += fmt::format("{} = {}  # {}; {:.4g} .. {:.4g}, from {:.4g}\n", number.name, fitted.value, number.unit, fitted.low, fitted.high,
                        number.start);
  };
  for (const TunedParameter& number : diagnosis.tuned) add(number, number.with_effects);
  for (const FittedNumber& number : diagnosis.numbers) add(number, number.fitted);
  return text;
}

}  // namespace musclesim
