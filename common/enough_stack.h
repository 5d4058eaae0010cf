// enough_stack.h: runs a program on a stack that is large enough, however small the one is that the shell gave it (ulimit -s).
// Worlds may nest a thousand nodes, and files within files; what walks over them recurses.
#pragma once

#include <functional>

#include <pthread.h>
#include <sys/resource.h>

// Runs a function on this thread, if its stack is or can grow to 8 MB, else on one that has such a stack; threads that are made
// later have it as well. Returns what the function returns; it must not throw. Called by main() before there are other threads.
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
