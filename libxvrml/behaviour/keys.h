// keys.h: finds the place of a fraction among the keys of an interpolator or sequencer. Pure
// functions. [any thread]
#pragma once

#include <algorithm>
#include <cstddef>

namespace xvrml {

// The position of a fraction: between the values `left` and `left` + 1, at parameter t. t 0:
// exactly the value `left`.
struct KeyPosition {
  size_t left;
  float t;
};

// Finds the position of a fraction (ISO/IEC 14772-1 4.6.8, ISO/IEC 19775-1 19.2.2). Below the first
// key it is the first value, above the last key the last value. At a repeated key it is the last of
// its values (the limit from the right), except at the ends. With decreasing keys the result is
// arbitrary but never out of bounds. count: at least 1. fraction: not NaN.
inline KeyPosition locate(const float* keys, size_t count, float fraction) {
  if (fraction <= keys[0]) return {0, 0};
  if (fraction >= keys[count - 1]) return {count - 1, 0};
  const size_t right = size_t(std::upper_bound(keys, keys + count, fraction) - keys);
  if (right == 0 || right == count) return {right == 0 ? 0 : count - 1, 0};
  const float from = keys[right - 1], to = keys[right];
  const float t = float((double(fraction) - from) / (double(to) - from));
  if (t >= 1) return {right, 0}; // rounded up
  return {right - 1, t > 0 ? t : 0};
}

} // namespace xvrml
