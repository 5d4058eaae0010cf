// dyadic.h: exact sums and products of doubles of any size, for the decisions that a Bounded number
// leaves open. A Dyadic is a whole number of any length times a power of two. It is about a hundred
// times slower than a double. Pure functions. [any thread]
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "backend/local/double/bounded.h"

namespace openrt {

// The digits of a Dyadic, lowest first. A few of them need no memory of their own.
class Limbs {
 public:
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  uint32_t* begin() { return many_.empty() ? few_ : many_.data(); }
  const uint32_t* begin() const { return many_.empty() ? few_ : many_.data(); }
  uint32_t* end() { return begin() + size_; }
  const uint32_t* end() const { return begin() + size_; }
  uint32_t& operator[](size_t i) { return begin()[i]; }
  uint32_t operator[](size_t i) const { return begin()[i]; }
  // Makes `size` digits of 0.
  void reset(size_t size) {
    if (size > std::size(few_)) many_.resize(size);
    size_ = size;
    std::fill(begin(), end(), 0u);
  }
  // Keeps the digits from `first` on, up to `last`.
  void keep(size_t first, size_t last) {
    std::copy(begin() + first, begin() + last, begin());
    size_ = last - first;
  }

 private:
  uint32_t few_[16];
  std::vector<uint32_t> many_; // in use if it is not empty
  size_t size_ = 0;
};

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
