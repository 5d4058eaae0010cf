// catalogue.h: the accuracy catalogue's line of each test: id, expected, got, tolerance, pass,
// time, rays. Comparisons of the tests are noted here; of each test the one that came nearest to
// its tolerance is printed when it ends. [one thread]
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

namespace numeric {

void noteComparison(double got, double expected, double tolerance);
void noteRays(uint64_t rays);

// What EXPECT_NEAR asks, noted.
inline testing::AssertionResult nearAndNoted(const char* a, const char* b, const char* c,
                                             double got, double expected, double tolerance) {
  noteComparison(got, expected, tolerance);
  return testing::internal::DoubleNearPredFormat(a, b, c, got, expected, tolerance);
}

} // namespace numeric

#undef EXPECT_NEAR
#define EXPECT_NEAR(got, expected, tolerance)                                                      \
  EXPECT_PRED_FORMAT3(::numeric::nearAndNoted, got, expected, tolerance)
