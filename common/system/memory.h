// memory.h: what the allocator of the C library says of a block. Any thread.
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

} // namespace os
