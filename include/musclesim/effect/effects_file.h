/// Effects files: {"format": "musclesim-effects-1", "effects": [{"id": ..., "component": ..., "parameters": {...}}]}.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/active_effect.h"

namespace musclesim {

/// Reads an effects file strictly: ids, names of parameters and values are checked against the catalogue.
/// Throws BadFile with file, line and what is allowed; IoError if it cannot be read.
std::vector<ActiveEffect> readEffects(const std::string& file);
/// The same from text in memory; `file` is used in messages only.
std::vector<ActiveEffect> parseEffects(const std::string& text, const std::string& file);

/// The text of an effects file; reading it gives the same bits. Throws BadParameter for effects that reading would refuse.
std::string effectsText(const std::vector<ActiveEffect>& effects);
/// Writes the file, to a temporary name first. Throws as effectsText; IoError.
void writeEffects(const std::vector<ActiveEffect>& effects, const std::string& file);

}  // namespace musclesim
