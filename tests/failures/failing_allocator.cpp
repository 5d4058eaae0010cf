// failing_allocator.cpp: the program's operator new and malloc replace those of all libraries. The
// return address identifies the caller. If the standard library allocates on behalf of a caller
// (std::string, std::vector out of line), the stack does.
#include "failures/failing_allocator.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <new>

#include <execinfo.h>
#include <link.h>

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* block);
}

namespace {

enum class Owner : uint8_t { other, project, standard, decoder };

struct Range {
  uintptr_t begin, end;
  Owner owner;
};
constexpr size_t maxRanges = 1024;
Range ranges[maxRanges];
std::atomic<size_t> rangeCount{0};

std::atomic<bool> armed{false}, hit{false};
std::atomic<uint64_t> count{0}, target{0};
std::atomic<int64_t> live{0};
thread_local bool inside = false;

// Libraries of the build tree belong to the project. The C libraries that decode pictures and
// glyphs are included for malloc. All others are left alone.
Owner ownerOf(const char* path) {
  if (!path || !*path) return Owner::other; // the test itself
  char real[PATH_MAX];                      // without the .. of a run path
  if (realpath(path, real)) path = real;
  if (std::strstr(path, FAILURES_BUILD "/")) return Owner::project;
  const char* name = std::strrchr(path, '/');
  name = name ? name + 1 : path;
  if (std::strncmp(name, "libstdc++", 9) == 0) return Owner::standard;
  for (const char* decoder : {"libpng", "libjpeg", "libgif", "libz.", "libfreetype"})
    if (std::strncmp(name, decoder, std::strlen(decoder)) == 0) return Owner::decoder;
  return Owner::other;
}

int addRanges(dl_phdr_info* info, size_t, void*) {
  const Owner owner = ownerOf(info->dlpi_name);
  for (int i = 0; owner != Owner::other && i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || !(header.p_flags & PF_X) || rangeCount == maxRanges) continue;
    const uintptr_t begin = info->dlpi_addr + header.p_vaddr;
    ranges[rangeCount++] = {begin, begin + header.p_memsz, owner};
  }
  return 0;
}

Owner ownerAt(const void* address) {
  const auto at = reinterpret_cast<uintptr_t>(address);
  for (size_t i = 0; i < rangeCount; ++i)
    if (at >= ranges[i].begin && at < ranges[i].end) return ranges[i].owner;
  return Owner::other;
}

// Returns the owner that calls through the standard library: the first frame outside of it.
Owner ownerOnStack() {
  constexpr int deepest = 24;
  void* frames[deepest];
  const int n = backtrace(frames, deepest);
  bool standard = false;
  for (int i = 0; i < n; ++i) {
    const Owner owner = ownerAt(frames[i]);
    if (owner == Owner::standard) standard = true;
    if (standard && owner != Owner::standard) return owner;
  }
  return Owner::other;
}

bool ofProject(const void* caller) {
  if (inside) return false;
  Owner owner = ownerAt(caller);
  if (owner == Owner::standard) {
    inside = true; // walking the stack may allocate
    owner = ownerOnStack();
    inside = false;
  }
  return owner == Owner::project;
}

bool fails() {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const bool now = ++count == target.load(std::memory_order_relaxed);
  if (now) hit = true;
  return now;
}

// Blocks of operator new have a header that says whether they belong to the project.
constexpr size_t headerBytes = 16;

void* allocate(size_t size, size_t alignment, const void* caller) {
  const bool counted = ofProject(caller);
  if (counted && fails()) return nullptr;
  const size_t front = alignment > headerBytes ? alignment : headerBytes;
  if (size > SIZE_MAX - front) return nullptr;
  void* whole = alignment > headerBytes ? __libc_memalign(alignment, size + front)
                                        : __libc_malloc(size + front);
  if (!whole) return nullptr;
  auto* block = static_cast<char*>(whole) + front;
  std::memcpy(block - sizeof counted, &counted, sizeof counted);
  if (counted) ++live;
  return block;
}

void release(void* block, size_t alignment) noexcept {
  if (!block) return;
  const size_t front = alignment > headerBytes ? alignment : headerBytes;
  bool counted = false;
  std::memcpy(&counted, static_cast<char*>(block) - sizeof counted, sizeof counted);
  if (counted) --live;
  __libc_free(static_cast<char*>(block) - front);
}

void* orThrow(void* block) {
  if (!block) throw std::bad_alloc();
  return block;
}

bool decoderFails(const void* caller) {
  if (inside || ownerAt(caller) != Owner::decoder || !fails()) return false;
  errno = ENOMEM;
  return true;
}

} // namespace

namespace failing_allocator {

void locate() {
  void* frames[2];
  backtrace(frames, 2); // loads the libraries that it needs
  rangeCount = 0;
  dl_iterate_phdr(addRanges, nullptr);
}

void arm(uint64_t failing) {
  count = 0;
  target = failing;
  hit = false;
  armed = true;
}

uint64_t disarm() {
  armed = false;
  return count;
}

bool failed() { return hit; }
int64_t blocks() { return live; }

} // namespace failing_allocator

#define CALLER __builtin_return_address(0)
void* operator new(size_t size) { return orThrow(allocate(size, 0, CALLER)); }
void* operator new[](size_t size) { return orThrow(allocate(size, 0, CALLER)); }
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, 0, CALLER);
}
void* operator new[](size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, 0, CALLER);
}
void* operator new(size_t size, std::align_val_t a) {
  return orThrow(allocate(size, size_t(a), CALLER));
}
void* operator new[](size_t size, std::align_val_t a) {
  return orThrow(allocate(size, size_t(a), CALLER));
}
void* operator new(size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return allocate(size, size_t(a), CALLER);
}
void* operator new[](size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return allocate(size, size_t(a), CALLER);
}
void operator delete(void* block) noexcept { release(block, 0); }
void operator delete[](void* block) noexcept { release(block, 0); }
void operator delete(void* block, size_t) noexcept { release(block, 0); }
void operator delete[](void* block, size_t) noexcept { release(block, 0); }
void operator delete(void* block, const std::nothrow_t&) noexcept { release(block, 0); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { release(block, 0); }
void operator delete(void* block, std::align_val_t a) noexcept { release(block, size_t(a)); }
void operator delete[](void* block, std::align_val_t a) noexcept { release(block, size_t(a)); }
void operator delete(void* block, size_t, std::align_val_t a) noexcept {
  release(block, size_t(a));
}
void operator delete[](void* block, size_t, std::align_val_t a) noexcept {
  release(block, size_t(a));
}

extern "C" {
void* malloc(size_t size) { return decoderFails(CALLER) ? nullptr : __libc_malloc(size); }
void* calloc(size_t n, size_t size) {
  return decoderFails(CALLER) ? nullptr : __libc_calloc(n, size);
}
void* realloc(void* block, size_t size) {
  return decoderFails(CALLER) ? nullptr : __libc_realloc(block, size);
}
}
