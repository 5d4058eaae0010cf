// memory.cpp: Wraps Python's two allocators: small objects come from the arenas of Python's own
// allocator, all others from the raw one. The context pointer stays that of the wrapped functions,
// so that a thread that allocates during the change sees a matching pair.
#include "memory.h"

#include <cstdlib>

#include <Python.h>

#include "system/memory.h"

namespace python {
namespace {

thread_local Account* account = nullptr;
PyMemAllocatorEx raw;
PyObjectArenaAllocator arenas;

bool mayTake(size_t bytes) {
  return !account ||
         (bytes <= size_t(INT64_MAX) && account->used + int64_t(bytes) <= account->most);
}
void* taken(void* memory) {
  if (memory && account) account->used += int64_t(os::blockBytes(memory));
  return memory;
}

void* rawMalloc(void* context, size_t bytes) {
  return mayTake(bytes) ? taken(raw.malloc(context, bytes)) : nullptr;
}
void* rawCalloc(void* context, size_t count, size_t bytes) {
  if (bytes > 0 && count > size_t(INT64_MAX) / bytes) return nullptr;
  return mayTake(count * bytes) ? taken(raw.calloc(context, count, bytes)) : nullptr;
}
void* rawRealloc(void* context, void* memory, size_t bytes) {
  if (!account) return raw.realloc(context, memory, bytes);
  const int64_t before = memory ? int64_t(os::blockBytes(memory)) : 0;
  if (int64_t(bytes) > before && !mayTake(bytes - size_t(before))) return nullptr;
  void* moved = raw.realloc(context, memory, bytes);
  if (moved) account->used += int64_t(os::blockBytes(moved)) - before;
  return moved;
}
void rawFree(void* context, void* memory) {
  if (memory && account) account->used -= int64_t(os::blockBytes(memory));
  raw.free(context, memory);
}
void* arenaAlloc(void* context, size_t bytes) {
  if (!mayTake(bytes)) return nullptr;
  void* arena = arenas.alloc(context, bytes);
  if (arena && account) account->used += int64_t(bytes);
  return arena;
}
void arenaFree(void* context, void* arena, size_t bytes) {
  if (account) account->used -= int64_t(bytes);
  arenas.free(context, arena, bytes);
}

// Returns whether Python uses debug wrappers; these return addresses inside blocks, so that the
// size of a block cannot be determined.
bool checksItself() {
#ifdef Py_DEBUG
  return true;
#else
  if (std::getenv("PYTHONMALLOC") || std::getenv("PYTHONDEVMODE") ||
      std::getenv("PYTHONTRACEMALLOC"))
    return true;
  if (!Py_IsInitialized()) return false;
  PyObject* flags = PySys_GetObject("flags"); // borrowed reference
  PyObject* mode = flags ? PyObject_GetAttrString(flags, "dev_mode") : nullptr;
  const bool development = mode && PyObject_IsTrue(mode) == 1;
  Py_XDECREF(mode);
  PyErr_Clear();
  return development;
#endif
}

} // namespace

void countMemory() {
  if (checksItself()) return;
  PyMem_GetAllocator(PYMEM_DOMAIN_RAW, &raw);
  PyMemAllocatorEx counted{raw.ctx, rawMalloc, rawCalloc, rawRealloc, rawFree};
  PyMem_SetAllocator(PYMEM_DOMAIN_RAW, &counted);
  PyObject_GetArenaAllocator(&arenas);
  PyObjectArenaAllocator countedArenas{arenas.ctx, arenaAlloc, arenaFree};
  PyObject_SetArenaAllocator(&countedArenas);
}

Account* chargeTo(Account* to) {
  Account* const before = account;
  account = to;
  return before;
}

} // namespace python
