// enough_stack.h: Runs a program on a large stack, however small the shell's limit is (ulimit -s).
// Worlds may nest a thousand nodes, and files may include files; the code that walks over them is
// recursive.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include <pthread.h>
#include <sys/resource.h>

#include "system/threads.h"

// Returns the free bytes of this thread's stack; 0: unknown.
inline size_t stackLeft() {
  thread_local const char* const lowest = os::stackBottom();
  const char here = 0;
  return lowest && &here > lowest ? size_t(&here - lowest) : 0;
}

// AddressSanitizer puts guards around the variables of functions, which then need a larger stack.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define OPENRT_GUARDED_STACK
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define OPENRT_GUARDED_STACK
#endif

// Runs work() on this thread if `bytes` of its stack are free, otherwise on another thread while
// this one waits. Returns the result of work() and rethrows its exceptions.
template <class Work> auto onStackOf(size_t bytes, const Work& work) -> decltype(work()) {
#ifdef OPENRT_GUARDED_STACK
  bytes *= 6;
#endif
  const size_t left = stackLeft();
  if (left == 0 || left >= bytes) return work();
  struct Job {
    const Work& work;
    std::optional<decltype(work())> result{};
    std::exception_ptr failure{};
  } job{work};
  const auto run = [](void* what) -> void* {
    Job& todo = *static_cast<Job*>(what);
    try {
      todo.result.emplace(todo.work());
    } catch (...) { todo.failure = std::current_exception(); }
    return nullptr;
  };
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, bytes + (size_t(1) << 20));
  pthread_t thread{};
  const bool made = pthread_create(&thread, &attributes, run, &job) == 0;
  pthread_attr_destroy(&attributes);
  if (!made) return work();
  pthread_join(thread, nullptr);
  if (job.failure) std::rethrow_exception(job.failure);
  return std::move(*job.result);
}

// Runs a function on this thread if its stack is, or can grow to, 8 MB, otherwise on a thread with
// such a stack; later threads get such a stack too. Returns the function's result; the function
// must not throw. main() calls this before it creates threads.
inline int withEnoughStack(const std::function<int()>& run) {
  constexpr rlim_t enough = rlim_t(8) << 20;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, enough);
  os::enlargeThreadStacks(attributes, enough);
  rlimit limit{};
  bool here = getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough;
  if (!here && limit.rlim_max >= enough) { // the kernel checks the limit when the stack grows
    limit.rlim_cur = enough;
    here = setrlimit(RLIMIT_STACK, &limit) == 0;
  }
  struct Job {
    const std::function<int()>& run;
    int code = 0;
  } job{run};
  pthread_t thread{};
  const auto work = [](void* what) -> void* {
    Job& todo = *static_cast<Job*>(what);
    todo.code = todo.run();
    return nullptr;
  };
  if (here || pthread_create(&thread, &attributes, work, &job) != 0)
    work(&job);
  else
    pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  return job.code;
}
