/// Effects files: {"format": "musclesim-effects-1", "effects": [{"id": ..., "component": ..., "parameters": {...}}]}.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/active_effect.h"

namespace musclesim {

/// Reads an effects file and checks ids, parameter names and values against the catalogue. Throws BadFile with the file, the line and what
/// is allowed, or IoError if the file cannot be read.
std::vector<ActiveEffect> readEffects(const std::string& file);
/// Like readEffects, for text in memory; `file` appears only in messages.
std::vector<ActiveEffect> parseEffects(const std::string& text, const std::string& file);

/// The text of an effects file; reading it back gives the same values to the bit. Throws BadParameter for effects that readEffects would
/// refuse.
std::string effectsText(const std::vector<ActiveEffect>& effects);
/// Writes an effects file, first under a temporary name. Throws like effectsText, or IoError.
void writeEffects(const std::vector<ActiveEffect>& effects, const std::string& file);

}  // namespace musclesim
