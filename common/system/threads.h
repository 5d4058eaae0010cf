// threads.h: the stack of a thread, and the processors that a process may use. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <thread>

#include <pthread.h>

#if defined(__linux__)
#include <sched.h>
#endif

namespace os {

// Returns the lowest address of this thread's stack; null: unknown.
inline const char* stackBottom() {
#if defined(__linux__)
  pthread_attr_t attributes;
  void* place = nullptr;
  size_t bytes = 0;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return nullptr;
  pthread_attr_getstack(&attributes, &place, &bytes);
  pthread_attr_destroy(&attributes);
  return static_cast<const char*>(place);
#elif defined(__APPLE__)
  const pthread_t self = pthread_self();
  return static_cast<const char*>(pthread_get_stackaddr_np(self)) - pthread_get_stacksize_np(self);
#else
  return nullptr;
#endif
}

// Gives later threads a stack as in `attributes`, if theirs would be smaller than `enough`. Does
// nothing where the C library has no such setting.
inline void enlargeThreadStacks(const pthread_attr_t& attributes, size_t enough) {
#ifdef __GLIBC__
  pthread_attr_t usual; // glibc's default is the soft limit
  size_t bytes = 0;
  if (pthread_getattr_default_np(&usual) == 0) {
    pthread_attr_getstacksize(&usual, &bytes);
    pthread_attr_destroy(&usual);
    if (bytes < enough) pthread_setattr_default_np(&attributes);
  }
#else
  (void)attributes;
  (void)enough;
#endif
}

// Returns the processors that the system lets this process use.
inline uint32_t allowedProcessors() {
#if defined(__linux__)
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return uint32_t(CPU_COUNT(&set));
#endif
  return std::thread::hardware_concurrency();
}

} // namespace os
