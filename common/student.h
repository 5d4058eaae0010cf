// student.h: Student's distribution: quantiles for 95 % intervals, and the chance of a value. Pure
// functions. libopenrt uses them for the error bars, libpicture to compare pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace student {

// Returns the quantile for two-sided intervals of level 95 %. degreesOfFreedom: 1 or more, may be
// fractional; below 10 it is rounded down.
inline double quantile95(double degreesOfFreedom) {
  static constexpr double table[] = {0,       12.7062, 4.30265, 3.18245, 2.77645,
                                     2.57058, 2.44691, 2.36462, 2.30600, 2.26216};
  const double v = degreesOfFreedom;
  if (v < double(std::size(table))) return table[std::max(1, int(v))];
  // M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 26.7.5
  const double z = 1.959963985, z3 = z * z * z, z5 = z3 * z * z;
  const double first = (z3 + z) / 4, second = (5 * z5 + 16 * z3 + 3 * z) / 96;
  const double third = (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / 384;
  return z + first / v + second / (v * v) + third / (v * v * v);
}

// The half-width of an interval of level 99 % divided by that of level 95 %, at 7 degrees of
// freedom: at least 8 replicates, which intervals have that are trusted. With more of them it is
// smaller.
inline constexpr double from95To99 = 3.49948 / 2.36462;

// Returns the probability that the absolute value of t exceeds a value (M. Abramowitz, I. Stegun,
// "Handbook of Mathematical Functions", 26.7.3 and 26.7.4). freedom: above 1.
inline double chanceBeyond(double value, int freedom) {
  const double angle = std::atan(value / std::sqrt(double(freedom)));
  const double cosine = std::cos(angle);
  const int first = freedom % 2; // the terms are those of odd or of even powers
  double term = first ? cosine : 1, sum = term;
  for (int k = first + 2; k <= freedom - 2; k += 2) {
    term *= cosine * cosine * (k - 1) / k;
    sum += term;
  }
  const double inside =
      first ? 2 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
  return std::clamp(1 - inside, 0.0, 1.0);
}

} // namespace student
