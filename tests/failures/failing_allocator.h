// failing_allocator.h: the allocator of alloc_failures. It counts what the project's libraries
// allocate and makes one of these allocations fail. Allocations of Embree, oneTBB and the test
// itself are left alone.
#pragma once

#include <cstdint>

namespace failing_allocator {

// Finds the address ranges of the libraries. Call it again after libraries have been loaded.
void locate();

// Counts the project's allocations from 1 on. The one with number `failing` fails (0: none).
void arm(uint64_t failing);
// Stops failing and returns the number of allocations since arm().
uint64_t disarm();
// Returns whether the allocation that was to fail has been requested since arm().
bool failed();

// Returns the number of blocks that the project has allocated and not freed.
int64_t blocks();

} // namespace failing_allocator
