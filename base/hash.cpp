#include "musclesim/base/hash.h"

#include <fmt/format.h>

namespace musclesim {

std::string Hash::text() const {
  return fmt::format("{:016x}", value_);
}

}  // namespace musclesim
