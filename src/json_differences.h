/// What differs between two JSON values.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::command_line {

struct JsonDifference {
  std::string name;         ///< of the member, "robot_parameters.rig.load_kg"
  std::string before, now;  ///< as JSON text; "null" where there is no such member
};

/// The members that differ; objects are compared member by member.
std::vector<JsonDifference> differencesOf(const nlohmann::json& before, const nlohmann::json& now, const std::string& name = "");

}  // namespace musclesim::command_line
