#include "plugin.h"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "musclesim/base/error.h"

namespace musclesim::command_line {

namespace {

/// Refuses a library that was cut: the loader maps its segments without a look at the file's size, and the first access ends the program.
void requireWhole(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream.tellg()));
  ElfW(Ehdr) header{};
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    throw BadFile(file, "is no shared library");
  stream.seekg(static_cast<std::streamoff>(header.e_phoff));
  for (int i = 0; i < header.e_phnum; ++i) {
    ElfW(Phdr) segment{};
    stream.read(reinterpret_cast<char*>(&segment), sizeof segment);
    if (!stream || segment.p_offset > size || segment.p_filesz > size - segment.p_offset)
      throw BadFile(file, "is a part of a shared library: its end is missing");
  }
}

}  // namespace

void loadPlugin(const std::string& file) {
  requireWhole(file);
  // With a slash in its name, the loader does not search the system's folders.
  void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw BadFile(file, std::string("cannot be loaded as a plugin: ") + dlerror());
  using Register = void (*)();
  const auto registerAll = reinterpret_cast<Register>(dlsym(library, "musclesim_plugin"));
  if (!registerAll) throw BadFile(file, "is no plugin: it must have a function extern \"C\" void musclesim_plugin()");
  registerAll();
}

}  // namespace musclesim::command_line
