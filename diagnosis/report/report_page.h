/// What every report.html has besides its contents: style sheet, script, glossary.
#pragma once

#include <string>

namespace musclesim {

/// CSS for screens, phones and paper.
std::string reportStyle();
/// JavaScript for the traces: drag to zoom, a cursor that all share, and keys.
std::string reportScript();

/// A word with its explanation, which opens in place: "noise floor" of the key "floor". Throws std::logic_error for an unknown key.
std::string term(const std::string& key);
std::string term(const std::string& key, const std::string& words);
/// The explanations that terms open; printed as a list.
std::string glossary();

}  // namespace musclesim
