// start_threads.h: Starts threads that do the same work. Where memory or processes are short, fewer
// of them do it; nothing depends on their number. Stateless; any thread.
#pragma once

#include <cstddef>
#include <thread>
#include <vector>

// Starts up to `count` threads, which call work(number), and appends them. Throws what
// std::thread throws if not one can be started.
template <class Work>
void startThreads(std::vector<std::thread>& threads, size_t count, const Work& work) {
  threads.reserve(threads.size() + count);
  for (size_t i = 0; i < count; ++i) {
    try {
      threads.emplace_back(work, i);
    } catch (...) {
      if (i == 0) throw;
      return;
    }
  }
}
