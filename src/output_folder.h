/// Where a command writes its files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace musclesim::program {

/// log/runs/<date-time>-<label>, with a number appended if that exists; not made yet.
std::filesystem::path freshFolder(const std::string& label);

/// The folder given, or a fresh one; made if it does not exist. Throws IoError if it cannot be made.
std::filesystem::path outputFolder(const std::optional<std::string>& given, const std::string& label);

/// Makes a folder and those above it. Throws IoError.
void makeFolder(const std::filesystem::path& folder);

}  // namespace musclesim::program
