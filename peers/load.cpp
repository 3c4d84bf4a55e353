#include "load.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace musclesim::peers {

namespace {

LoadedEngine load(const std::filesystem::path& folder, const std::string& name) {
  std::string lower = name;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::filesystem::path file = folder / fmt::format("musclesim_peer_{}.so", lower);
  if (!std::filesystem::exists(file))
    return {name, nullptr, fmt::format("not built: lib{}-dev was not installed when musclesim was configured", lower)};
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return {name, nullptr, dlerror()};
  using Get = const PeerEngine* (*)();
  const auto get = reinterpret_cast<Get>(dlsym(library, ("musclesim_peer_" + lower).c_str()));
  if (!get) return {name, nullptr, dlerror()};
  return {name, get(), ""};
}

}  // namespace

std::vector<LoadedEngine> loadEngines() {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "peers";
  std::vector<LoadedEngine> engines;
  for (const char* name : {"MuJoCo", "Simbody", "Bullet"}) engines.push_back(load(folder, name));
  return engines;
}

}  // namespace musclesim::peers
