// openrt_keep_running.cpp: Tests the guard of the loops of threads.
#include "keep_running.h"

#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

TEST(KeepRunning, AnExceptionEndsAStepAndNotTheLoop) {
  int steps = 0, recovered = 0;
  keepRunning([&] { return steps == 5; },
              [&] {
                if (++steps == 2) throw std::bad_alloc();
                if (steps == 4) throw 4;
              },
              [&] {
                ++recovered;
                throw std::runtime_error("the same shortage of memory");
              });
  EXPECT_EQ(steps, 5);
  EXPECT_EQ(recovered, 2);
}

TEST(KeepRunning, AStepIsRepeatedUntilItSucceeds) {
  int steps = 0;
  repeatUntilDone([] { return false; },
                  [&] {
                    if (++steps < 3) throw std::bad_alloc();
                  });
  EXPECT_EQ(steps, 3);
  bool isEnding = false;
  repeatUntilDone([&] { return isEnding; },
                  [&] {
                    isEnding = true;
                    ++steps;
                    throw std::bad_alloc();
                  });
  EXPECT_EQ(steps, 4);
}
