// bounded.h: a double together with a bound of its error: running error analysis (J. H. Wilkinson;
// N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed. 2002, section 3.3). Every
// operation adds to the errors of its operands what they do to the result, and the rounding of the
// result itself, half a unit of the last place. Pure functions. [any thread]
#pragma once

#include <cmath>
#include <limits>

namespace openrt {

struct Bounded {
  double value = 0;
  double error = 0; // |value - the true number| is at most this; infinite or NaN: nothing is known

  static constexpr double unit = 0x1p-53;
  // More than what products and quotients lose that are too small for a double, also where
  // denormal numbers become 0.
  static constexpr double tiny = 0x1p-1000;
  // Covers the rounding of the bounds themselves: at most 6 operations each.
  static constexpr double inflated = 1 + 0x1p-49;

  Bounded(double v = 0) : value(v) {} // exact; implicit, so that formulas take constants
  Bounded(double v, double e) : value(v), error(e) {}

  // Returns 1 or -1, or 0 if the sign is not certain. Comparisons with NaN are false.
  int sign() const { return value > error ? 1 : value < -error ? -1 : 0; }

  Bounded operator-() const { return {-value, error}; }
  friend Bounded operator+(const Bounded& a, const Bounded& b) {
    const double v = a.value + b.value;
    return {v, (a.error + b.error + unit * std::fabs(v)) * inflated};
  }
  friend Bounded operator-(const Bounded& a, const Bounded& b) { return a + -b; }
  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    const double v = a.value * b.value;
    return {v, (std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error +
                unit * std::fabs(v)) *
                       inflated +
                   tiny};
  }
  // A / B - a / b = ((A - a) - (a / b) (B - b)) / B, and |B| is at least |b| - the error of b.
  friend Bounded operator/(const Bounded& a, const Bounded& b) {
    const double v = a.value / b.value, least = std::fabs(b.value) - b.error * inflated;
    if (!(least > 0)) return {v, std::numeric_limits<double>::infinity()};
    return {v,
            ((a.error + std::fabs(v) * b.error) / (least * (1 - 0x1p-52)) + unit * std::fabs(v)) *
                    inflated +
                tiny};
  }
};

// Returns the root of a number that is known to be positive. sqrt(A) - sqrt(a) = (A - a) / (sqrt(A)
// + sqrt(a)).
inline Bounded sqrt(const Bounded& a) {
  const double v = std::sqrt(a.value);
  return {v, (a.error / v + Bounded::unit * v) * Bounded::inflated + Bounded::tiny};
}

// Returns the one whose error is smaller. Both stand for the same number.
inline const Bounded& better(const Bounded& a, const Bounded& b) {
  return !(a.error <= b.error) ? b : a;
}

} // namespace openrt
