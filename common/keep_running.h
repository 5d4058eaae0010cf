// keep_running.h: Keeps the loop of a thread alive. An exception that leaves a thread ends the
// process, and memory may be short for a while only. [any thread]
#pragma once

#include <chrono>
#include <thread>

// Calls step() until ended(). After an exception it calls recover(), whose own exceptions are
// ignored, and waits a little before the next step.
template <class Ended, class Step, class Recover>
void keepRunning(const Ended& ended, const Step& step, const Recover& recover) noexcept {
  while (!ended()) {
    try {
      step();
      continue;
    } catch (...) {}
    try {
      recover();
    } catch (...) {} // the next step recovers
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

// Calls step() until it succeeds, or ended().
template <class Ended, class Step> void repeatUntilDone(const Ended& ended, const Step& step) {
  bool isDone = false;
  keepRunning([&] { return isDone || ended(); },
              [&] {
                step();
                isDone = true;
              },
              [] {});
}
