/// The seal beside the recordings, and how far away a key must be.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace musclesim::blind {

/// DIR/seal.json as an object. Throws BadFile if it is not one, IoError if it cannot be read.
nlohmann::json readSeal(const std::filesystem::path& folder);
/// Any JSON object. Throws as readSeal.
nlohmann::json readObject(const std::filesystem::path& file);
void writeObject(const nlohmann::json& object, const std::filesystem::path& file);

/// Names of the folders caseNNN in DIR, in order.
std::vector<std::string> caseNames(const std::filesystem::path& folder);
/// All files of the cases, relative to DIR, in order.
std::vector<std::string> recordingFiles(const std::filesystem::path& folder);

/// A readable file of that name in DIR or below, in DIR's parent, in the working folder, or in a folder directly in either of these.
std::optional<std::filesystem::path> keyInReach(const std::string& key_name, const std::filesystem::path& folder);
/// Whether keyInReach() would find a key in `key_folder`.
bool isInReach(const std::filesystem::path& key_folder, const std::filesystem::path& folder);

/// Members that say which program wrote a file: "program", "program_sha256" and, if known, "commit".
nlohmann::json programMembers(const std::string& commit);

}  // namespace musclesim::blind
