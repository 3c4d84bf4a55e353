/// The texts of the files in robots/, which CMake makes a part of the library.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace musclesim::description {

/// Name and text.
const std::vector<std::pair<std::string, std::string>>& shippedFiles();

}  // namespace musclesim::description
