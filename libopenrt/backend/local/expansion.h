// expansion.h: exact sums and products of doubles, for the signs that double precision cannot
// decide. An expansion is a sum of doubles that do not overlap, smallest first (J. R. Shewchuk:
// Adaptive precision floating-point arithmetic and fast robust geometric predicates, Discrete &
// Computational Geometry 18, 1997). Exact as long as no product leaves the range of doubles. Pure
// functions. [any thread]
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace openrt {

// The rounded result of an operation, and its rounding error. high + low is exact.
struct TwoTerms {
  double high, low;
};

inline TwoTerms exactSum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

inline TwoTerms exactProduct(double a, double b) {
  // Splits a number into halves of 26 bits, whose products are exact.
  const auto split = [](double x) {
    const double c = 134217729.0 * x, high = c - (c - x);
    return TwoTerms{high, x - high};
  };
  const double product = a * b;
  const TwoTerms x = split(a), y = split(b);
  const double rest = ((x.high * y.high - product) + x.high * y.low) + x.low * y.high;
  return {product, rest + x.low * y.low};
}

class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double value) { add(value); }
  Expansion(const Expansion& e) : count_(e.count_) {
    std::copy_n(e.terms_.begin(), count_, terms_.begin());
  }
  Expansion& operator=(const Expansion& e) {
    count_ = e.count_;
    std::copy_n(e.terms_.begin(), count_, terms_.begin());
    return *this;
  }
  // Returns the exact difference of two doubles.
  static Expansion difference(double a, double b) {
    const TwoTerms d = exactSum(a, -b);
    Expansion e;
    e.add(d.low);
    e.add(d.high);
    return e;
  }

  // Adds a number (GROW-EXPANSION). Terms that become 0 are dropped.
  void add(double b) {
    size_t kept = 0;
    double carry = b;
    for (size_t i = 0; i < count_; i++) {
      const TwoTerms s = exactSum(carry, terms_[i]);
      carry = s.high;
      if (s.low != 0) terms_[kept++] = s.low;
    }
    assert(kept < capacity);
    if (carry != 0) terms_[kept++] = carry;
    count_ = kept;
  }
  Expansion& operator+=(const Expansion& e) {
    for (size_t i = 0; i < e.count_; i++) add(e.terms_[i]);
    return *this;
  }
  Expansion operator-() const {
    Expansion e = *this;
    for (size_t i = 0; i < count_; i++) e.terms_[i] = -e.terms_[i];
    return e;
  }
  friend Expansion operator-(const Expansion& a, const Expansion& b) {
    Expansion e = a;
    return e += -b;
  }
  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion e;
    for (size_t i = 0; i < a.count_; i++)
      for (size_t k = 0; k < b.count_; k++) {
        const TwoTerms p = exactProduct(a.terms_[i], b.terms_[k]);
        e.add(p.low);
        e.add(p.high);
      }
    return e;
  }

  int sign() const { return count_ == 0 ? 0 : terms_[count_ - 1] > 0 ? 1 : -1; }
  // Returns the value, rounded: its relative error is below 2^-50.
  double rounded() const {
    double sum = 0;
    for (size_t i = 0; i < count_; i++) sum += terms_[i];
    return sum;
  }

 private:
  // The largest expansions are those of sideOfPoint() in crossing.cpp: three products of 16 terms
  // with 4 terms, and each product of two terms has two, 384 in all.
  static constexpr size_t capacity = 800;
  size_t count_ = 0;
  std::array<double, capacity> terms_;
};

} // namespace openrt
