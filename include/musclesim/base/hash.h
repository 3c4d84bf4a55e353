/// Hashes that detect changes: equal for equal bytes, almost surely different otherwise. They do not protect against forgery.
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
  /// Adds the bits of the number: -0 and 0 differ.
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

}  // namespace musclesim
