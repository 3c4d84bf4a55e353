#include "json_differences.h"

namespace musclesim::command_line {

std::vector<JsonDifference> differencesOf(const nlohmann::json& before, const nlohmann::json& now, const std::string& name) {
  if (before == now) return {};
  if (!before.is_object() || !now.is_object()) return {{name, before.dump(), now.dump()}};
  std::vector<JsonDifference> all;
  nlohmann::json members = before;
  members.update(now);
  for (const auto& [member, value] : members.items()) {
    auto within = differencesOf(before.value(member, nlohmann::json()), now.value(member, nlohmann::json()),
                                name.empty() ? member : name + "." + member);
    all.insert(all.end(), within.begin(), within.end());
  }
  return all;
}

}  // namespace musclesim::command_line
