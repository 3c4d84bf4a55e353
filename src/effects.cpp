/// `musclesim effects`: lists the catalogue of effects, or describes one of them.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim::command_line {

namespace {

struct EffectsArguments {
  std::string id;
  bool json = false;
};

std::string componentsOf(const EffectInfo& info) {
  std::string names;
  for (const ComponentKind kind : info.acts_on) {
    static const char* const forms[] = {"all, muscle_<i>",
                                        "muscle_<i>+muscle_<j>",
                                        "all",
                                        "all, joint_<name>",
                                        "all, slide_<name>",
                                        "hand",
                                        "base",
                                        "all, signal_<column without unit>"};
    names += (names.empty() ? "" : "; ") + std::string(forms[static_cast<std::size_t>(kind)]);
  }
  return names;
}

std::string neutralText(const EffectParameter& parameter) {
  if (!parameter.choices.empty()) return parameter.choices[static_cast<std::size_t>(parameter.neutral)];
  return fmt::format("{}", parameter.neutral);
}

std::string rangeText(const EffectParameter& parameter) {
  if (!parameter.choices.empty()) return fmt::format("{}", fmt::join(parameter.choices, " | "));
  return fmt::format("{} .. {}", parameter.minimum, parameter.maximum);
}

void printList() {
  Stage stage = Stage::sensor;
  bool first = true;
  for (const EffectInfo& info : effectCatalogue()) {
    if (first || info.stage != stage) fmt::print("{}{}\n", first ? "" : "\n", nameOf(info.stage));
    first = false;
    stage = info.stage;
    fmt::print("  {:<24} {}\n", info.id, info.summary);
  }
}

void printOne(const EffectInfo& info) {
  fmt::print("{}: {}\n\n", info.id, info.summary);
  fmt::print("stage       {}\ncomponent   {}\nequation    {}\nsignature   {}\nsource      {}\n", nameOf(info.stage), componentsOf(info),
             info.equation, info.signature, info.source);
  if (info.parameters.empty()) return;
  fmt::print("\n{:<28} {:<10} {:<18} {:<20} {:<18} {}\n", "parameter", "unit", "neutral", "range", "usually", "meaning");
  for (const EffectParameter& p : info.parameters)
    fmt::print("{:<28} {:<10} {:<18} {:<20} {:<18} {}\n", p.name, p.unit, neutralText(p) + (p.shape ? " (default)" : ""), rangeText(p),
               p.choices.empty() ? fmt::format("{} .. {}", p.usual_low, p.usual_high) : "", p.meaning);
}

nlohmann::json toJson(double number) {
  return std::isfinite(number) ? nlohmann::json(number) : nlohmann::json(number > 0 ? "inf" : "-inf");
}

nlohmann::json toJson(const EffectInfo& info) {
  nlohmann::json json = {{"id", info.id},
                         {"stage", nameOf(info.stage)},
                         {"component", componentsOf(info)},
                         {"summary", info.summary},
                         {"equation", info.equation},
                         {"signature", info.signature},
                         {"source", info.source},
                         {"parameters", nlohmann::json::array()}};
  for (const EffectParameter& p : info.parameters)
    json["parameters"].push_back({{"name", p.name},
                                  {"unit", p.unit},
                                  {"neutral", toJson(p.neutral)},
                                  {"range", {toJson(p.minimum), toJson(p.maximum)}},
                                  {"usual", {toJson(p.usual_low), toJson(p.usual_high)}},
                                  {"meaning", p.meaning},
                                  {"shape", p.shape},
                                  {"choices", p.choices}});
  return json;
}

int effects(const EffectsArguments& arguments) {
  if (arguments.json) {
    nlohmann::json list = nlohmann::json::array();
    if (arguments.id.empty())
      for (const EffectInfo& info : effectCatalogue()) list.push_back(toJson(info));
    fmt::print("{}\n", (arguments.id.empty() ? nlohmann::json{{"effects", list}} : toJson(effectInfo(arguments.id))).dump());
  } else if (arguments.id.empty()) {
    printList();
  } else {
    printOne(effectInfo(arguments.id));
  }
  return done;
}

}  // namespace

Action addEffects(CLI::App& command) {
  auto arguments = std::make_shared<EffectsArguments>();
  command.add_option("id", arguments->id, "Describe this effect: equation, parameters, units, ranges and source");
  command.add_flag("--json", arguments->json, "Print one JSON object");
  return [arguments] { return effects(*arguments); };
}

}  // namespace musclesim::command_line
