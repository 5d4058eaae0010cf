// memory.h: how much memory the functions of a Script hold: Python's allocators are wrapped, and
// answer NULL (MemoryError) beyond the Script's limit. What libraries allocate themselves, as numpy
// does for its arrays, is not counted. Any thread.
#pragma once

#include <cstdint>

namespace python {

struct Account {
  int64_t used = 0;
  int64_t most = INT64_MAX;
};

// From now on allocations are counted; once in a process, before Python starts or with its lock.
// Does nothing where Python checks its memory itself (PYTHONMALLOC, development mode).
void countMemory();

// The account of what this thread allocates; null: nobody's. Returns the one before.
Account* chargeTo(Account* account);

} // namespace python
