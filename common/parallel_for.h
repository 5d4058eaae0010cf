// parallel_for.h: A parallel loop that ThreadSanitizer can check. oneTBB is not built with the
// sanitizer, which sees no order among its tasks; reports about them would all be wrong and are
// suppressed, and races of the loop's body with them. So a build with the sanitizer runs the parts
// on threads of its own. Otherwise this is tbb::parallel_for. [any thread]
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
#include <exception>
#include <thread>

// Halves the range until it has a part for each of four threads, or cannot be divided.
template <class Range, class F> void parallelForParts(Range range, const F& f, int halvings) {
  if (halvings == 0 || !range.is_divisible()) return f(range);
  std::exception_ptr failure;
  Range second(range, tbb::split()); // takes half of the range away
  std::thread other([&] {
    try {
      parallelForParts(second, f, halvings - 1);
    } catch (...) { failure = std::current_exception(); }
  });
  try {
    parallelForParts(range, f, halvings - 1);
  } catch (...) {
    other.join();
    throw;
  }
  other.join();
  if (failure) std::rethrow_exception(failure);
}
#endif

// Calls f(part) for parts that make up a range, on several threads at once. Returns when all calls
// have returned.
template <class Range, class F> void parallelFor(const Range& range, const F& f) {
#ifdef PARALLEL_FOR_SANITIZED
  if (!range.empty()) parallelForParts(range, f, 2);
#else
  tbb::parallel_for(range, f);
#endif
}

// Calls f(begin, end) for ranges of numbers that make up 0 to count, on several threads if there
// are many.
template <class F> void forRanges(std::size_t count, const F& f) {
  constexpr std::size_t grain = 16384;
  if (count <= grain) return f(std::size_t(0), count); // there are millions of small arrays
  parallelFor(tbb::blocked_range<std::size_t>(0, count, grain),
              [&](const auto& range) { f(range.begin(), range.end()); });
}
