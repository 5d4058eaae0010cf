// memory.h: what the allocator of the C library says of a block, and what it keeps for later. Any
// thread.
#pragma once

#include <cstddef>

#if defined(__APPLE__)
#include <malloc/malloc.h>
#else
#include <malloc.h>
#endif

namespace os {

// Returns the bytes that a block of malloc has.
inline size_t blockBytes(void* memory) {
#if defined(__APPLE__)
  return malloc_size(memory);
#else
  return malloc_usable_size(memory);
#endif
}

// Gives freed memory back to the system, where the C library keeps it otherwise. Takes some
// milliseconds: call it when the program rests.
inline void giveBackMemory() {
#if defined(__GLIBC__)
  ::malloc_trim(0);
#endif
}

} // namespace os
