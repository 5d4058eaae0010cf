// dyadic.h: exact sums and products of doubles of any size, for the decisions that a Bounded number
// leaves open. A Dyadic is a whole number of any length times a power of two. It is about a hundred
// times slower than a double. Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <vector>

#include "backend/local/precise/bounded.h"

namespace openrt {

class Dyadic {
 public:
  Dyadic(double value = 0); // must be finite; implicit, as a double from an int

  Dyadic operator-() const;
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);

  int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }
  // Returns the number, rounded. Numbers beyond the range of doubles become infinite or 0.
  Bounded rounded() const;
  // Returns a / b, rounded; b must not be 0. Only the quotient must be in the range of doubles.
  friend Bounded quotient(const Dyadic& a, const Dyadic& b);

 private:
  using Limbs = std::vector<uint32_t>;
  // Returns m with |m| from 1 to 2^32, so that the number is m * 2^exponent within 2^-51 |m|.
  double mantissa(int& exponent) const;
  void trim();

  // The number is the sum of limbs_[i] * 2^(32 (first_ + i)), negated if negative_. Neither the
  // first nor the last limb is 0.
  Limbs limbs_;
  int first_ = 0;
  bool negative_ = false;
};

} // namespace openrt
