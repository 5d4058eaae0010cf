// srgb.h: The transfer function of sRGB (IEC 61966-2-1) and its inverse, in the precision of the
// argument. [any thread]
#pragma once

#include <cmath>

template <class T> T encodeSrgb(T linear) {
  return linear <= T(0.0031308) ? T(12.92) * linear
                                : T(1.055) * std::pow(linear, 1 / T(2.4)) - T(0.055);
}

template <class T> T decodeSrgb(T encoded) {
  return encoded <= T(0.04045) ? encoded / T(12.92)
                               : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}
