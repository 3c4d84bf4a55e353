/// Fingerprints: equal for equal bytes, almost surely different otherwise. Not against forgery.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace musclesim {

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    value_ = (value_ ^ bytes.size()) * 0x100000001b3ULL;
  }
  /// By its bits: -0 and 0 differ.
  void add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    add(std::string_view(reinterpret_cast<const char*>(&bits), sizeof bits));
  }
  std::uint64_t value() const { return value_; }
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// All registered robots with their default parameters: names, masses and places of the primitives, lengths and limits of the muscles,
/// parameters. Differs when a robot was changed, so that a sweep is not finished with another model than it was begun with.
std::string robotsHash();

}  // namespace musclesim
