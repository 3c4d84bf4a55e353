/// Work that is done in a process of its own, because the library that does it may crash or use up the memory on a hostile file.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace musclesim {

/// Sanitizers take terabytes of addresses and much more time; under them there are no limits. GCC names them by macros, clang by features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool apart_is_limited = false;
#elif defined(__has_feature)
inline constexpr bool apart_is_limited = !__has_feature(address_sanitizer);
#else
inline constexpr bool apart_is_limited = true;
#endif

struct ApartLimits {
  std::size_t memory_bytes = std::size_t{256} << 20;  ///< beyond what this process has
  unsigned processor_s = 1;
};

/// Calls `work` in a copy of this process (fork) and returns the text that it returns. Throws BadFile with the message of an error that it
/// throws, or `file` with what ended the copy. Only the calling thread exists in the copy, so `work` must not wait for another.
std::string doApart(const std::string& file, const ApartLimits& limits, const std::function<std::string()>& work);

}  // namespace musclesim
