#include "program_in_path.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace musclesim {

std::filesystem::path programInPath(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / name;
    std::error_code ignored;
    if (candidate.is_absolute() && access(candidate.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(candidate, ignored))
      return candidate;
  }
  return {};
}

}  // namespace musclesim
