#include "program_build.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace musclesim::command_line {

namespace {

constexpr std::size_t alignedNoteBytes(std::size_t bytes) {
  return (bytes + 3) & ~std::size_t{3};
}

/// The build id in a segment of notes; empty if there is none.
std::string buildIdIn(const char* notes, std::size_t size) {
  std::size_t at = 0;
  while (at + sizeof(ElfW(Nhdr)) <= size) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, notes + at, sizeof note);
    const char* name = notes + at + sizeof note;
    const char* content = name + alignedNoteBytes(note.n_namesz);
    at += sizeof note + alignedNoteBytes(note.n_namesz) + alignedNoteBytes(note.n_descsz);
    if (at > size || note.n_type != NT_GNU_BUILD_ID || note.n_namesz != 4 || std::memcmp(name, "GNU", 4) != 0) continue;
    std::string id;
    for (std::size_t i = 0; i < note.n_descsz; ++i) id += fmt::format("{:02x}", static_cast<unsigned char>(content[i]));
    return id;
  }
  return "";
}

std::string buildIdOf(const dl_phdr_info& object) {
  for (std::size_t i = 0; i < object.dlpi_phnum; ++i) {
    const auto& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const std::string id = buildIdIn(reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr), segment.p_filesz);
    if (!id.empty()) return id;
  }
  return "unknown";
}

/// Whether the numbers of a simulation depend on this shared library.
bool isNumerical(const std::string& library) {
  return std::ranges::any_of(std::initializer_list<const char*>{"libode.", "libm.", "libmusclesim"},
                             [&](const char* name) { return library.starts_with(name); });
}

int addObject(dl_phdr_info* object, std::size_t, void* result) {
  auto& build = *static_cast<std::map<std::string, std::string>*>(result);
  const std::string library = std::filesystem::path(object->dlpi_name).filename().string();
  if (library.empty())
    build.emplace("program", buildIdOf(*object));  // the program itself comes first; the kernel's object has no name either
  else if (isNumerical(library))
    build.emplace(library, buildIdOf(*object));
  return 0;
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (const auto colon = line.find(": "); line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

}  // namespace

std::map<std::string, std::string> programBuild() {
  std::map<std::string, std::string> build;
  dl_iterate_phdr(addObject, &build);
  build.emplace("processor", processorName());
  return build;
}

}  // namespace musclesim::command_line
