#include "sentences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace musclesim {

std::string effectSentence(const FoundEffect& effect) {
  std::string text = effect.label();
  const char* separator = ": ";
  for (const auto& [name, estimate] : effect.parameters) {
    text += fmt::format("{}{} = {:.4g} ({:.4g} to {:.4g})", separator, name, estimate.value, estimate.low, estimate.high);
    separator = ", ";
  }
  return text;
}

std::string whereSentence(const Diagnosis& d) {
  const Place& place = d.where.front();
  return fmt::format("{:.0f} % in the {} stage, {}{}", 100 * place.share, place.stage, place.component,
                     place.regime.empty() ? "" : ", while " + place.regime);
}

std::string verdictSentence(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::no_gap:
      return "No gap: the recordings agree with the model up to the noise.";
    case Verdict::not_excited:
      return "I cannot tell: the commands rest, so the recordings do not show what the plant does.";
    case Verdict::unexplained: {
      std::string text = "There is a gap that I cannot explain";
      if (!d.effects.empty())
        text += fmt::format(": the best candidate, {}, has a probability of {:.0f} %", d.effects.front().label(),
                            100 * d.effects.front().probability);
      return text + ".";
    }
    case Verdict::effects_found: {
      std::string text = fmt::format("Adding {} removes {:.1f} % of the gap on data it had not seen ({:.1f} to {:.1f})",
                                     fmt::join(d.chosen, " and "), d.shrink_percent, d.shrink_low_percent, d.shrink_high_percent);
      std::vector<std::string> others;
      for (const std::string& label : d.ambiguity_set)
        if (std::ranges::find(d.chosen, label) == d.chosen.end()) others.push_back(label);
      if (!others.empty() && d.chosen.size() == 1) text += fmt::format("; {} would explain it as well", fmt::join(others, " or "));
      if (!others.empty() && d.chosen.size() > 1)
        text += fmt::format("; in place of {}, {} would do as well", d.chosen.back(), fmt::join(others, " or "));
      return text + ".";
    }
  }
  return "";
}

}  // namespace musclesim
