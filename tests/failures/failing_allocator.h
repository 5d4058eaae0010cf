// failing_allocator.h: the allocator of alloc_failures. It counts what the project's libraries
// allocate, and makes one of these allocations fail. What Embree, oneTBB and the test itself
// allocate is left alone.
#pragma once

#include <cstdint>

namespace failing_allocator {

// Finds where the libraries lie in memory. Call it again after libraries have been loaded.
void locate();

// From here on allocations of the project are counted from 1; the one with number `failing` fails
// (0: none).
void arm(uint64_t failing);
// Returns how many there were since arm(). Nothing fails any more.
uint64_t disarm();
// Whether the allocation that was to fail has been asked for since arm().
bool failed();

// Blocks that the project has and that are not freed.
int64_t blocks();

} // namespace failing_allocator
