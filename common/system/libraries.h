// libraries.h: what the loader says of loaded libraries, beyond dlsym and dladdr. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <dlfcn.h>

#if defined(__linux__)
#include <link.h>
#else
#include <unistd.h>
#endif

namespace os {

// Returns the value of an environment variable; null if there is none, or if the program has more
// rights than its user, who could choose its libraries by it.
inline const char* trustedEnvironment(const char* name) {
#if defined(__linux__)
  return secure_getenv(name);
#else
  return issetugid() ? nullptr : std::getenv(name);
#endif
}

// Returns the size of the object that an exported symbol names; 0 if it is unknown. Where symbols
// have no sizes, it is the largest number, so that nothing seems to be missing.
inline size_t exportedBytes(void* symbol) {
#if defined(__linux__)
  Dl_info info{};
  ElfW(Sym)* entry = nullptr;
  if (dladdr1(symbol, &info, reinterpret_cast<void**>(&entry), RTLD_DL_SYMENT) == 0 || !entry ||
      info.dli_saddr != symbol)
    return 0;
  return entry->st_size;
#else
  (void)symbol;
  return SIZE_MAX;
#endif
}

// Returns whether a library itself defines the function that dlsym found in it. dlsym also finds
// functions of its dependencies.
inline bool defines(void* library, void* function) {
  Dl_info info{};
  if (!function || dladdr(function, &info) == 0) return false;
#if defined(__linux__)
  link_map* map = nullptr;
  return dlinfo(library, RTLD_DI_LINKMAP, &map) == 0 &&
         reinterpret_cast<uintptr_t>(info.dli_fbase) == uintptr_t(map->l_addr);
#else
  // Opening a library again gives the same handle.
  void* const owner = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  if (owner) dlclose(owner);
  return owner == library;
#endif
}

} // namespace os
