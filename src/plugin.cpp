#include "plugin.h"

#include <dlfcn.h>

#include <filesystem>

#include "musclesim/base/error.h"

namespace musclesim::command_line {

void loadPlugin(const std::string& file) {
  // With a slash in its name, the loader does not search the system's folders.
  void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw BadFile(file, std::string("cannot be loaded as a plugin: ") + dlerror());
  using Register = void (*)();
  const auto registerAll = reinterpret_cast<Register>(dlsym(library, "musclesim_plugin"));
  if (!registerAll) throw BadFile(file, "is no plugin: it must have a function extern \"C\" void musclesim_plugin()");
  registerAll();
}

}  // namespace musclesim::command_line
