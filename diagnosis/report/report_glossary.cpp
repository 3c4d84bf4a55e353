#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "report_page.h"

namespace musclesim {

namespace {

struct GlossaryEntry {
  const char *key, *words, *explanation;
};

constexpr std::array<GlossaryEntry, 13> entries = {{
    {"gap", "gap",
     "The difference between what was measured and what the model says for the same commands, beyond the noise of the sensors. "
     "Shares of it are shares of its square."},
    {"residual", "residual", "Measured minus simulated, at one moment in one signal."},
    {"floor", "noise floor",
     "The standard deviation of a signal's own noise. A residual of 1 noise floor is noise alone; the grey band in the plots reaches 2 "
     "noise "
     "floors to each side and holds 95 % of the noise."},
    {"held_out", "data not used for fitting",
     "The last recording, or the last two fifths of the only one. Neither fitting nor choosing used it, so it tests the answer fairly."},
    {"probability", "probability",
     "How much these recordings and what is known of such machines speak for a cause, compared with the other causes of the catalogue and "
     "with none of them. It is the sum over all explanations that hold the cause, so causes that act together can all be probable."},
    {"interval", "95 % interval",
     "The range in which the number lies with a probability of 95 % if the machine follows the program's law of this effect. If it follows "
     "another law, trust the place and the kind of the effect more than the last digit. No interval is given where the recordings say no "
     "more about the number than is known of such machines anyway."},
    {"refit", "model re-tuned",
     "A control: the model's own numbers are fitted to the recordings, without any effect. An explanation should remove clearly more."},
    {"sham", "disturbance without meaning",
     "A control: a disturbance of the commands that has no physical meaning and as many numbers to fit. An explanation should remove "
     "clearly "
     "more."},
    {"stage", "stage",
     "A sample goes from the command to the pressure in the muscle, the force of the muscle, the motion of the body and the reading of the "
     "sensor. The percentages are degrees of belief, not parts of the gap."},
    {"phase", "filling, venting and holding", "The times at which the commands rise, fall and rest."},
    {"muscle", "muscle 0",
     "Muscles are counted from 0: the columns of muscle 0 in a recording end in _0, such as command_0 or length_0_mm."},
    {"alone", "alone and beside the others",
     "Alone: how much of the gap this cause removes without the others. Beside the others: how much comes back if it is taken out of the "
     "explanation, without fitting the others anew."},
    {"attempt", "rejected explanation",
     "The explanation that comes nearest. It is not believed, because it does not explain the gap well enough or a cause outside the "
     "catalogue "
     "is likelier; it is a starting point, not a finding."},
}};

const GlossaryEntry& entryOf(const std::string& key) {
  const auto found = std::ranges::find_if(entries, [&](const GlossaryEntry& entry) { return key == entry.key; });
  if (found == entries.end()) throw std::logic_error("the glossary has no " + key);
  return *found;
}

}  // namespace

std::string term(const std::string& key) {
  return term(key, entryOf(key).words);
}

std::string term(const std::string& key, const std::string& words) {
  return fmt::format("<button type=button class=term popovertarget=\"about-{}\">{}</button>", entryOf(key).key, words);
}

std::string glossary() {
  std::string text = "<section class=glossary aria-label=\"Words\">";
  for (const GlossaryEntry& entry : entries)
    text += fmt::format("<div popover id=\"about-{}\"><b>{}</b>: {}</div>\n", entry.key, entry.words, entry.explanation);
  return text + "</section>\n";
}

}  // namespace musclesim
