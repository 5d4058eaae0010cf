// local_origin.h: Defines about which origin the API stores points that are given in double, as
// floats. libopenrt uses it, and so do bindings that must know the floats. Pure functions.
#pragma once

#include <cmath>

namespace openrt {

inline bool fitsFloat(double v) { return static_cast<double>(static_cast<float>(v)) == v; }

// Returns the origin of one coordinate of points that lie between low and high: about the middle,
// on a grid of the size of the range. Points of which every coordinate fits a float keep 0 instead.
inline double localOrigin(double low, double high) {
  const double middle = low + 0.5 * (high - low);
  if (high == low) return low;
  const double grid = std::exp2(std::ceil(std::log2(high - low)));
  const double rounded = std::round(middle / grid) * grid;
  return std::isfinite(rounded) ? rounded : middle;
}

} // namespace openrt
