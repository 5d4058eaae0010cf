// parallel_for.h: A parallel loop that ThreadSanitizer understands. oneTBB is not built with the
// sanitizer, which therefore sees no order between the caller and the tasks. Without the sanitizer
// this is tbb::parallel_for. [any thread]
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PARALLEL_FOR_SANITIZED
#endif
#elif defined(__SANITIZE_THREAD__)
#define PARALLEL_FOR_SANITIZED
#endif

#ifdef PARALLEL_FOR_SANITIZED
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

// Calls f(part) for parts that make up a range, on several threads at once. Returns when all calls
// have returned.
template <class Range, class F> void parallelFor(const Range& range, const F& f) {
#ifdef PARALLEL_FOR_SANITIZED
  // Two marks: what the caller has done comes before each task, and each task before what the
  // caller does afterwards. Tasks have no order among each other, so that their races are found.
  char begin = 0, end = 0;
  __tsan_release(&begin);
  tbb::parallel_for(range, [&](const Range& part) {
    __tsan_acquire(&begin);
    f(part);
    __tsan_release(&end);
  });
  __tsan_acquire(&end);
#else
  tbb::parallel_for(range, f);
#endif
}
