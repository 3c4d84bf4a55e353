/// Effects as JSON, in the form of sidecars and effects files.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "musclesim/log/active_effect.h"

namespace musclesim {

/// A function that throws. Its arguments are the path of a value, the value, and what is allowed there.
using RefuseJson = std::function<void(const std::string& path, const nlohmann::json& value, const std::string& allowed)>;

/// Reads a list of {"id", "component", "parameters"}; infinity is written "inf". Ids and parameter names are not checked.
std::vector<ActiveEffect> effectsFromJson(const nlohmann::json& list, const std::string& path, const RefuseJson& refuse);
/// Throws BadParameter for a parameter that is neither a number nor plus infinity.
nlohmann::ordered_json jsonOf(const std::vector<ActiveEffect>& effects);

/// A JSON value as text for a message.
std::string shortJson(const nlohmann::json& value);

}  // namespace musclesim
