// memory.h: Counts the memory that the functions of a Script hold. Python's allocators are wrapped
// and return NULL (MemoryError) beyond the Script's limit. Memory that libraries allocate
// themselves, such as numpy's arrays, is not counted. Any thread.
#pragma once

#include <cstdint>

namespace python {

struct Account {
  int64_t used = 0;
  int64_t most = INT64_MAX;
};

// Starts counting; call it once per process, before Python starts or with its lock. Does nothing if
// Python checks its memory itself (PYTHONMALLOC, development mode).
void countMemory();

// Sets the account for allocations of this thread; null: none. Returns the previous one.
Account* chargeTo(Account* account);

} // namespace python
