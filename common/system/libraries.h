// libraries.h: what the loader says of loaded libraries, beyond dlsym and dladdr, and whether a
// file can be one. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include <dlfcn.h>
#include <sys/stat.h>

#if defined(__linux__)
#include <cstring>

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

// Returns why a file cannot be loaded as a library: it is no regular file, or it is shorter than
// its headers say. Empty if nothing is known; other faults are for the loader to tell.
inline std::string whyIncomplete(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
  if (!S_ISREG(info.st_mode)) return "it is not a regular file";
#if defined(__linux__)
  const auto size = uint64_t(info.st_size);
  std::ifstream file(path, std::ios::binary);
  ElfW(Ehdr) head{};
  const bool isElf = size >= SELFMAG && file.read(reinterpret_cast<char*>(&head), SELFMAG) &&
                     std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0;
  if (!isElf) return {};
  const std::string early = "it is damaged: it ends before its headers say";
  if (size < sizeof head) return early;
  file.seekg(0);
  file.read(reinterpret_cast<char*>(&head), sizeof head);
  constexpr int own = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
  if (!file || head.e_ident[EI_CLASS] != own || head.e_phentsize != sizeof(ElfW(Phdr))) return {};
  const uint64_t table = uint64_t(head.e_phnum) * sizeof(ElfW(Phdr));
  if (head.e_phoff > size || table > size - head.e_phoff) return early;
  for (uint64_t i = 0; i < head.e_phnum; ++i) {
    ElfW(Phdr) part{};
    file.seekg(std::streamoff(head.e_phoff + i * sizeof part));
    if (!file.read(reinterpret_cast<char*>(&part), sizeof part)) return early;
    const bool isMapped = part.p_type == PT_LOAD || part.p_type == PT_DYNAMIC;
    if (isMapped && (part.p_offset > size || part.p_filesz > size - part.p_offset)) return early;
  }
#endif
  return {};
}

} // namespace os
