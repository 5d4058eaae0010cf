// enough_stack.h: runs a program on a stack that is large enough, however small the one is that the
// shell gave it (ulimit -s). Worlds may nest a thousand nodes, and files within files; what walks
// over them recurses.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include <pthread.h>
#include <sys/resource.h>

// Bytes of this thread's stack below the caller; 0: not known.
inline size_t stackLeft() {
  thread_local const char* lowest = [] {
    pthread_attr_t attributes;
    void* place = nullptr;
    size_t bytes = 0;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0)
      return static_cast<const char*>(nullptr);
    pthread_attr_getstack(&attributes, &place, &bytes);
    pthread_attr_destroy(&attributes);
    return static_cast<const char*>(place);
  }();
  const char here = 0;
  return lowest && &here > lowest ? size_t(&here - lowest) : 0;
}

// Runs work() on this thread if so many bytes of its stack are left, else on a thread of its own
// while this one waits. Returns what it returns, and throws what it throws.
template <class Work> auto onStackOf(size_t bytes, const Work& work) -> decltype(work()) {
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

// Runs a function on this thread, if its stack is or can grow to 8 MB, else on one that has such a
// stack; threads that are made later have it as well. Returns what the function returns; it must
// not throw. Called by main() before there are other threads.
inline int withEnoughStack(const std::function<int()>& run) {
  constexpr rlim_t enough = rlim_t(8) << 20;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, enough);
#ifdef __GLIBC__
  pthread_attr_t usual; // glibc takes the soft limit
  size_t bytes = 0;
  if (pthread_getattr_default_np(&usual) == 0) {
    pthread_attr_getstacksize(&usual, &bytes);
    pthread_attr_destroy(&usual);
    if (bytes < enough) pthread_setattr_default_np(&attributes);
  }
#endif
  rlimit limit{};
  bool here = getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough;
  if (!here && limit.rlim_max >= enough) { // the kernel asks for the limit when the stack grows
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
