// Draws a figure for each effect of the catalogue: a standard recording of rig or elbow, with and without the effect.
// Usage: effect_figures DOCUMENT.md   (writes the document's section "catalogue", and the figures to figures/effects beside it)
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "effect_recordings.h"
#include "log/axis.h"
#include "log/curve.h"
#include "log/svg.h"
#include "musclesim/base/file.h"
#include "musclesim/effect/relevance.h"
#include "study.h"

using namespace musclesim;

namespace {

const Color clean_color{0.55, 0.55, 0.55, "clean"}, effect_color{0.85, 0.25, 0.1, "effect"};
constexpr double width = 760, height = 340, left = 62, right = 14, panel_height = 122;

struct Case {
  std::string robot, component;
  std::vector<std::string> signals;  ///< one per panel, two in all
};

/// Robot and component on which the figure shows the effect.
Case caseOf(const EffectInfo& info) {
  const bool on_rig =
      info.stage == Stage::force || info.stage == Stage::pressure || (info.stage == Stage::command && info.id != "channel_swap");
  if (info.id == "slide_friction") return {"rig", "slide_guide", {"force_0_N", "length_0_mm"}};
  if (on_rig) return {"rig", "all", {info.stage == Stage::force ? "force_0_N" : "pressure_0", "length_0_mm"}};
  if (info.stage == Stage::sensor) return {"elbow", "signal_angle_elbow", {"angle_elbow_deg", "length_0_mm"}};
  Simulation simulation;
  const std::string component = componentsFor(info, simulation.build("elbow")).front();
  const bool command = info.stage == Stage::command || info.stage == Stage::pressure;
  return {"elbow", component, {command ? "pressure_1" : "force_0_N", "angle_elbow_deg"}};
}

void drawPanel(Svg& svg, const Recording& clean, const Recording& with, const std::string& signal, double top, bool last) {
  const SvgBox box{left, top, width - left - right, panel_height};
  const Signal &a = *clean.find(signal), &b = *with.find(signal);
  Extent time, value;
  time.add(clean.time_s);
  value.add(a.values);
  value.add(b.values);
  const Axis x(time, box.left, box.right(), 7, false), y(value, box.bottom(), box.top, 4, true);
  for (const double tick : y.ticks()) {
    svg.line({box.left, y.pixel(tick)}, {box.right(), y.pixel(tick)}, "#e4e4e4", 1);
    svg.text({box.left - 6, y.pixel(tick) + 4}, y.label(tick), {11, SvgAnchor::end, "#333333", false, false});
  }
  svg.frame(box, "#555555");
  for (const auto& [recording, color] : {std::pair{&a, clean_color}, std::pair{&b, effect_color}})
    svg.curve(curvePieces(clean.time_s, recording->values, x, y, Between::straight), color, 1.4, box, recording->name);
  svg.text({16, box.top + panel_height / 2}, signal, {12, SvgAnchor::middle, "#333333", false, true});
  if (!last) return;
  for (const double tick : x.ticks())
    svg.text({x.pixel(tick), box.bottom() + 15}, x.label(tick), {11, SvgAnchor::middle, "#333333", false, false});
  svg.text({box.right(), box.bottom() + 30}, "time in s", {12, SvgAnchor::end, "#333333", false, false});
}

std::string settingOf(const ActiveEffect& effect) {
  std::string text;
  const EffectInfo info = effectInfo(effect.id);
  const std::vector<std::size_t> relevant = relevantParameters(info, effect.component);
  for (const auto& [name, value] : effect.parameters) {
    const auto parameter = std::find_if(info.parameters.begin(), info.parameters.end(), [&](const auto& p) { return p.name == name; });
    if (std::ranges::find(relevant, static_cast<std::size_t>(parameter - info.parameters.begin())) == relevant.end()) continue;
    if (std::holds_alternative<double>(value) && std::get<double>(value) == parameter->neutral) continue;
    const std::string number =
        std::holds_alternative<double>(value) ? fmt::format("{:g}", std::get<double>(value)) : std::get<std::string>(value);
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, number);
  }
  return text;
}

std::string rangeOf(const EffectParameter& p) {
  return p.choices.empty() ? fmt::format("{:g} .. {:g}", p.minimum, p.maximum) : fmt::format("{}", fmt::join(p.choices, ", "));
}

std::string neutralOf(const EffectParameter& p) {
  return p.choices.empty() ? fmt::format("{:g}", p.neutral) : p.choices[static_cast<std::size_t>(p.neutral)];
}

/// The document's section on one effect.
std::string describe(const EffectInfo& info) {
  std::string text = fmt::format("### {}\n\n{}.\n\n    {}\n\nSignature: {}. Source: {}.\n\n", info.id, info.summary, info.equation,
                                 info.signature, info.source);
  if (!info.parameters.empty()) text += "| parameter | unit | neutral | range | usually | meaning |\n|---|---|---|---|---|---|\n";
  for (const EffectParameter& p : info.parameters)
    text += fmt::format("| `{}` | {} | {}{} | {} | {} | {} |\n", p.name, p.unit, neutralOf(p), p.shape ? " (default)" : "", rangeOf(p),
                        p.choices.empty() ? fmt::format("{:g} .. {:g}", p.usual_low, p.usual_high) : "", p.meaning);
  return text + fmt::format("{}![{}](figures/effects/{}.svg)\n\n", info.parameters.empty() ? "" : "\n", info.id, info.id);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: effect_figures DOCUMENT.md\n");
    return 2;
  }
  const std::filesystem::path folder = std::filesystem::path(arguments[1]).parent_path() / "figures" / "effects";
  std::string text;
  Stage stage = Stage::sensor;
  std::filesystem::create_directories(folder);
  const Recording rig = study::standardRig(), elbow = study::standardElbow(), tense_rig = study::standardRig(0.75);
  const Recording clean_rig = study::simulate(rig, {}), clean_elbow = study::simulate(elbow, {}),
                  clean_tense_rig = study::simulate(tense_rig, {});
  for (const EffectInfo& info : effectCatalogue()) {
    const Case shown = caseOf(info);
    const bool on_rig = shown.robot == "rig", tense = info.id == "supply_droop";  // a demand that the supply cannot meet
    const Recording& commands = tense ? tense_rig : on_rig ? rig : elbow;
    const Recording& clean = tense ? clean_tense_rig : on_rig ? clean_rig : clean_elbow;
    const ActiveEffect effect = study::shownEffect(info, shown.component);
    const Recording with = study::simulate(commands, {effect});
    Svg svg(width, height, info.id);
    svg.text({left, 20}, fmt::format("{} on {} of the {}", info.id, effect.component, shown.robot),
             {14, SvgAnchor::start, "#111111", true, false});
    svg.text({width - right, 20}, settingOf(effect), {11, SvgAnchor::end, "#333333", false, false});
    svg.sample({left, 36}, 18, clean_color, 1.6);
    svg.text({left + 24, 40}, "clean", {11, SvgAnchor::start, "#333333", false, false});
    svg.sample({left + 80, 36}, 18, effect_color, 1.6);
    svg.text({left + 104, 40}, "with the effect", {11, SvgAnchor::start, "#333333", false, false});
    drawPanel(svg, clean, with, shown.signals[0], 50, false);
    drawPanel(svg, clean, with, shown.signals[1], 50 + panel_height + 12, true);
    replaceFile((folder / (info.id + ".svg")).string(), svg.document());
    if (info.stage != stage) text += fmt::format("## {}\n\n", nameOf(info.stage));
    stage = info.stage;
    text += describe(info);
  }
  writeSection(arguments[1], "catalogue", "effect_figures", text);
}
