/// Where a command writes its files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace musclesim::program {

/// log/runs/<date-time>-<label>, with a number appended if that exists; not made yet.
std::filesystem::path freshFolder(const std::string& label);

/// The folder given, or a fresh one; made if it does not exist. Throws IoError if it cannot be made.
std::filesystem::path outputFolder(const std::optional<std::string>& given, const std::string& label);

/// Makes a folder and those above it. Throws IoError.
void makeFolder(const std::filesystem::path& folder);

/// Throws IoError if nothing can be written into a folder.
void requireWritable(const std::filesystem::path& folder);

/// Throws BadParameter unless a recording's file ends in .csv, and makes the folder it is to be in. Throws IoError if that cannot be made.
void prepareRecording(const std::filesystem::path& csv);

/// Throws BadParameter if a recording of that name would replace one that was not simulated, another table or another JSON file.
void requireReplaceable(const std::filesystem::path& csv);

/// Throws BadParameter if a file that is to be written is one of those that are read.
void requireOther(const std::filesystem::path& output, const std::vector<std::string>& inputs);

}  // namespace musclesim::program
