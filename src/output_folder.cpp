#include "output_folder.h"

#include <fmt/format.h>

#include <ctime>

#include "musclesim/error.h"

namespace musclesim::program {

namespace fs = std::filesystem;

fs::path freshFolder(const std::string& label) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y-%m-%d-%H%M%S", &local);
  const fs::path first = fs::path("log") / "runs" / fmt::format("{}-{}", stamp, label);
  fs::path folder = first;
  for (int i = 2; fs::exists(folder); ++i) folder = fmt::format("{}-{}", first.string(), i);
  return folder;
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
}

fs::path outputFolder(const std::optional<std::string>& given, const std::string& label) {
  const fs::path folder = given ? fs::path(*given) : freshFolder(label);
  makeFolder(folder);
  return folder;
}

}  // namespace musclesim::program
