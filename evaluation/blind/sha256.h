/// Fingerprints: SHA-256 (FIPS 180-4).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace musclesim::blind {

/// 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// Fingerprint of a file's contents. Throws IoError if it cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

/// Fingerprint of several files: that of the lines "fingerprint  name", names relative to the folder, in the order given.
std::string sha256OfFiles(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Fingerprint of the running program.
std::string sha256OfProgram();

}  // namespace musclesim::blind
