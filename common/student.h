// student.h: quantiles of Student's distribution, for 95 % intervals. Pure function. libopenrt uses
// it for the error bars, and libpicture for the bias between pictures.
#pragma once

#include <algorithm>
#include <iterator>

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

} // namespace student
