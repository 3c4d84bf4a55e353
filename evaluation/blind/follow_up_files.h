/// The files that `musclesim blind follow` writes, one per case.
#pragma once

#include <filesystem>
#include <string>

namespace musclesim::blind {

/// SHA-256 of the answer that a follow-up belongs to.
std::string answerFingerprint(const std::filesystem::path& folder, const std::string& name);
std::filesystem::path followUpFile(const std::filesystem::path& folder, const std::string& name);
/// Whether there is a file, made from the present answer.
bool isFollowed(const std::filesystem::path& folder, const std::string& name);

}  // namespace musclesim::blind
