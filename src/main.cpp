/// The program `musclesim`.
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "musclesim/program.h"

namespace {

/// Memory that was freed is kept for the next use. A diagnosis frees and takes megabytes thousands of times: where each goes back to the
/// system in between, three recordings of a two-joint arm took a seventh longer on two cores.
void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int megabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * megabyte);  // the most that is allowed
  mallopt(M_TRIM_THRESHOLD, 1024 * megabyte);
  mallopt(M_TOP_PAD, 64 * megabyte);
#endif
}

}  // namespace

int main(int argument_count, char** arguments) {
  keepFreedMemory();
  std::_Exit(musclesim::program(argument_count, arguments));  // all files are closed; a cleanup would only take time
}
