/// One libFuzzer program for all targets. Usage: FUZZ_TARGET=recording_csv fuzz CORPUS [options of libFuzzer]
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

namespace {

musclesim::FuzzTarget chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("FUZZ_TARGET");
  for (const auto& [known, target] : musclesim::fuzzTargets())
    if (name && known == name) chosen = target;
  if (chosen) return 0;
  std::fprintf(stderr, "FUZZ_TARGET must be one of:");
  for (const auto& [known, target] : musclesim::fuzzTargets()) std::fprintf(stderr, " %s", known.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
