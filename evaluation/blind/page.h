/// The page about a check on withheld causes.
#pragma once

#include <filesystem>
#include <string>

#include "score.h"

namespace musclesim::blind {

/// Markdown: method, rates beside their aims, tables by kind, robot, size and effect, every failure.
std::string pageText(const Score& score);

/// Writes FOLDER/blind.md and FOLDER/figures/blind_*.svg.
void writePage(const Score& score, const std::filesystem::path& folder);

}  // namespace musclesim::blind
