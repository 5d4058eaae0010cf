// openrt_double_numbers.cpp: Dyadic numbers are exact, and Bounded numbers are within their
// bounds.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "backend/local/double/dyadic.h"

namespace openrt {
namespace {

class DoubleNumbers : public testing::Test {
 protected:
  std::mt19937_64 random_{5};
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  // Returns a double of any size, also 0 and with few digits.
  double any(int exponents) {
    if (whole(0, 15) == 0) return 0;
    const int bits = whole(1, 53);
    const auto digits = double(int64_t(random_() >> (64 - bits)) * (whole(0, 1) ? 1 : -1));
    return std::ldexp(digits, whole(-exponents, exponents));
  }
};

__int128 wideOf(double x) { return __int128(x); }

TEST_F(DoubleNumbers, SumsAndProductsAreThoseOfWholeNumbers) {
  for (int i = 0; i < 20000; i++) {
    // Whole numbers below 2^60 in 53 bits: products of two and sums of those fit into 128 bits.
    const double a = std::ldexp(any(0), whole(0, 7)), b = std::ldexp(any(0), whole(0, 7)),
                 c = std::ldexp(any(0), whole(0, 7)), d = any(0);
    const __int128 wanted = wideOf(a) * wideOf(b) - wideOf(c) * wideOf(d);
    const Dyadic found = Dyadic(a) * b - Dyadic(c) * d;
    ASSERT_EQ(found.sign(), wanted > 0 ? 1 : wanted < 0 ? -1 : 0) << i;
    Dyadic same; // from pieces of 50 bits
    for (const int shift : {100, 50, 0}) {
      const __int128 piece =
          shift == 100 ? wanted >> 100 : (wanted >> shift) & ((__int128(1) << 50) - 1);
      same = same + Dyadic(double(piece)) * std::ldexp(1, shift);
    }
    EXPECT_EQ((found - same).sign(), 0) << i;
    const Bounded rounded = found.rounded();
    EXPECT_NEAR(rounded.value, double(wanted), rounded.error);
  }
}

TEST_F(DoubleNumbers, SumsOfDifferentSizesLoseNothing) {
  for (int i = 0; i < 5000; i++) {
    const double a = any(900), b = any(900), c = any(900);
    const Dyadic x(a), y(b), z(c);
    EXPECT_EQ((x + y + z - x - z - y).sign(), 0);
    EXPECT_EQ(((x + y) * z - x * z - y * z).sign(), 0);
    EXPECT_EQ(((x - y) * (x + y) - x * x + y * y).sign(), 0);
    EXPECT_EQ((x - y).sign(), a > b ? 1 : a < b ? -1 : 0);
    EXPECT_EQ((-x).sign(), -x.sign());
    const Bounded same = x.rounded();
    EXPECT_LE(std::fabs(same.value - a), same.error);
  }
}

TEST_F(DoubleNumbers, EveryOperationStaysWithinItsBound) {
  const auto expectWithin = [](const Bounded& found, const Dyadic& truth) {
    const Dyadic off = Dyadic(found.value) - truth, bound(found.error);
    EXPECT_TRUE((bound - off).sign() >= 0 && (bound + off).sign() >= 0);
  };
  for (int i = 0; i < 20000; i++) {
    const double a = any(150), b = any(150), c = any(150), d = any(150);
    const Bounded sum = Bounded(a) * b + c, product = sum * (Bounded(d) - c);
    const Dyadic exactSum = Dyadic(a) * b + c, exactProduct = exactSum * (Dyadic(d) - c);
    expectWithin(sum, exactSum);
    expectWithin(product, exactProduct);
    if (product.sign() != 0) { EXPECT_EQ(product.sign(), exactProduct.sign()); }
    if (sum.sign() == 0) continue;
    // q is within its bound of p / s if |q s - p| <= bound |s|.
    const Bounded q = product / sum, same = quotient(exactProduct, exactSum);
    for (const Bounded& each : {q, same}) {
      const Dyadic off = Dyadic(each.value) * exactSum - exactProduct,
                   bound = Dyadic(each.error) * exactSum * exactSum.sign();
      EXPECT_TRUE((bound - off).sign() >= 0 && (bound + off).sign() >= 0);
    }
    if (sum.sign() < 0) continue;
    const Bounded root = sqrt(sum);
    const Dyadic high = Dyadic(root.value) + root.error, low = Dyadic(root.value) - root.error;
    EXPECT_GE((high * high - exactSum).sign(), 0);
    if (low.sign() > 0) { EXPECT_LE((low * low - exactSum).sign(), 0); }
  }
}

TEST_F(DoubleNumbers, WhatIsUnknownHasNoSign) {
  EXPECT_EQ((Bounded(1) / Bounded(0x1p-60, 0x1p-50)).sign(), 0);
  EXPECT_EQ((Bounded(1e300) * 1e300 - Bounded(1e300) * 1e300).sign(), 0);
  EXPECT_EQ((Bounded(1e-300) * 1e-300).sign(), 0);
  EXPECT_EQ((Dyadic(1e-300) * 1e-300).sign(), 1);
  EXPECT_EQ((Dyadic(1e300) * 1e300 - Dyadic(1e300) * 1e300 + 5e-324).sign(), 1);
  EXPECT_EQ(quotient(Dyadic(1e300) * 1e300, Dyadic(1e300) * -1e299).value, -10);
}

} // namespace
} // namespace openrt
