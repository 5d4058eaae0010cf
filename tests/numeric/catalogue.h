// catalogue.h: prints the accuracy catalogue's line of each test: id, expected, got, tolerance,
// pass, time, rays. The tests' comparisons are recorded here. At the end of each test the one
// closest to its tolerance is printed. [one thread]
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

namespace numeric {

void noteComparison(double got, double expected, double tolerance);
void noteRays(uint64_t rays);

// Checks what EXPECT_NEAR checks and records the comparison.
inline testing::AssertionResult nearAndNoted(const char* a, const char* b, const char* c,
                                             double got, double expected, double tolerance) {
  noteComparison(got, expected, tolerance);
  return testing::internal::DoubleNearPredFormat(a, b, c, got, expected, tolerance);
}

} // namespace numeric

#undef EXPECT_NEAR
#define EXPECT_NEAR(got, expected, tolerance)                                                      \
  EXPECT_PRED_FORMAT3(::numeric::nearAndNoted, got, expected, tolerance)
