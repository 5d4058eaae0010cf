// steady_clock.h: Seconds of the clock that never goes back. [any thread]
#pragma once

#include <chrono>

inline double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
