#include "short_names.h"

#include <algorithm>
#include <filesystem>

namespace musclesim {

std::vector<std::string> shortNames(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) names.push_back(std::filesystem::path(file).filename().string());
  std::vector<std::string> result = names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::filesystem::path folder = std::filesystem::path(files[i]).parent_path().filename();
    if (std::ranges::count(names, names[i]) > 1 && !folder.empty()) result[i] = (folder / names[i]).string();
  }
  return result;
}

}  // namespace musclesim
