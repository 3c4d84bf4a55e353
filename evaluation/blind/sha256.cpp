#include "sha256.h"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>

#include "musclesim/base/file.h"

namespace musclesim::blind {

namespace {
constexpr std::size_t digest_limit_bytes = std::size_t{1} << 30;
}

std::string sha256(std::string_view bytes) {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

std::string sha256OfFile(const std::filesystem::path& file) {
  return sha256(readTextFile(file.string(), digest_limit_bytes));
}

std::string sha256OfFiles(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  std::string lines;
  for (const std::string& name : names) lines += fmt::format("{}  {}\n", sha256OfFile(folder / name), name);
  return sha256(lines);
}

std::string sha256OfProgram() {
  return sha256OfFile("/proc/self/exe");
}

}  // namespace musclesim::blind
