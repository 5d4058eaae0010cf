// thread_clock.h: Seconds of processor time that the calling thread has used. Each reading is a
// call of the operating system. [any thread]
#pragma once

#include <ctime>

inline double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}
