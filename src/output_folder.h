/// Output files and folders of a command.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace musclesim::command_line {

/// The path log/runs/<date-time>-<label>, with a number appended if it exists. The folder is not created.
std::filesystem::path freshFolder(const std::string& label);

/// The given folder, or a fresh one. Creates it if it does not exist. Throws IoError if it cannot be created.
std::filesystem::path outputFolder(const std::optional<std::string>& given, const std::string& label);

/// Creates a folder and its parents. Throws IoError.
void makeFolder(const std::filesystem::path& folder);

/// Throws IoError if nothing can be written into a folder.
void requireWritable(const std::filesystem::path& folder);

/// Throws BadParameter unless the path of a recording ends in .csv. Creates its folder; throws IoError if it cannot be created.
/// Returns true if there was no such folder.
bool prepareRecording(const std::filesystem::path& csv);

/// Throws BadParameter if there is a recording of a run that has been finished; the message names --overwrite.
void requireUnfinished(const std::filesystem::path& csv);

/// Throws BadParameter if an output file is also an input file.
void requireOther(const std::filesystem::path& output, const std::vector<std::string>& inputs);

}  // namespace musclesim::command_line
