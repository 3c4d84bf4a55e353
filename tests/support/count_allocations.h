/// Counts calls of operator new in every thread of this program. Replaces the global operators: include it in one source of a program.
#pragma once

#include <cstdlib>
#include <new>

namespace musclesim {

/// Number of calls in the calling thread.
inline thread_local long allocation_count = 0;

/// Must not be inlined: compilers would see malloc and free where they expect new and delete.
[[gnu::noinline]] inline void freeAllocation(void* memory) noexcept {
  std::free(memory);
}
/// Calls malloc, or aligned_alloc if `alignment` is not 0. Throws std::bad_alloc.
[[gnu::noinline]] inline void* countedAllocation(std::size_t size, std::size_t alignment = 0) {
  ++allocation_count;
  if (void* memory = alignment ? std::aligned_alloc(alignment, size) : std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace musclesim

void* operator new(std::size_t size) {
  return musclesim::countedAllocation(size);
}
void* operator new[](std::size_t size) {
  return musclesim::countedAllocation(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return musclesim::countedAllocation(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++musclesim::allocation_count;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  musclesim::freeAllocation(memory);
}
void operator delete[](void* memory) noexcept {
  musclesim::freeAllocation(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  musclesim::freeAllocation(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  musclesim::freeAllocation(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  musclesim::freeAllocation(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  musclesim::freeAllocation(memory);
}
