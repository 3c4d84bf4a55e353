#include "musclesim/base/unique_name.h"

#include <fmt/format.h>

#include <random>

namespace musclesim {

std::string uniqueName() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

}  // namespace musclesim
