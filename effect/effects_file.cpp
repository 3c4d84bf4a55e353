#include "musclesim/effect/effects_file.h"

#include <fmt/format.h>

#include "../log/effect_json.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/json_document.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim {

namespace {

using nlohmann::json;

constexpr const char* effects_format = "musclesim-effects-1";
constexpr std::size_t file_limit_bytes = std::size_t{1} << 20;

void requireMembers(const JsonDocument& document) {
  for (const auto& [member, value] : document.root().items())
    if (member != "format" && member != "effects")
      document.refuse(member, fmt::format("member {}: must be \"format\" or \"effects\"", shortJson(member)));
  const json* format = document.find("format");
  if (!format) document.refuse("format", fmt::format("member \"format\" is missing: must be \"{}\"", effects_format));
  if (*format != effects_format) document.refuse("format", fmt::format("format = {}: must be \"{}\"", shortJson(*format), effects_format));
  if (!document.find("effects")) document.refuse("effects", "member \"effects\" is missing: must be a list, empty if there are none");
}

}  // namespace

std::vector<ActiveEffect> parseEffects(const std::string& text, const std::string& file) {
  const JsonDocument document(text, file);
  requireMembers(document);
  const auto effects =
      effectsFromJson(*document.find("effects"), "effects", [&](const std::string& path, const json& value, const std::string& allowed) {
        document.refuse("effects", fmt::format("{} = {}: must {}", path, shortJson(value), allowed));
      });
  for (std::size_t i = 0; i < effects.size(); ++i) try {
      effectValues(effectInfo(effects[i].id), effects[i]);
    } catch (const BadParameter& error) {
      document.refuse("effects", fmt::format("effects[{}]: {}", i, error.what()));
    }
  return effects;
}

std::vector<ActiveEffect> readEffects(const std::string& file) {
  return parseEffects(readTextFile(file, file_limit_bytes), file);
}

std::string effectsText(const std::vector<ActiveEffect>& effects) {
  for (const ActiveEffect& effect : effects) effectValues(effectInfo(effect.id), effect);
  const nlohmann::ordered_json root = {{"format", effects_format}, {"effects", jsonOf(effects)}};
  return root.dump(2) + "\n";
}

void writeEffects(const std::vector<ActiveEffect>& effects, const std::string& file) {
  replaceFile(file, effectsText(effects));
}

}  // namespace musclesim
