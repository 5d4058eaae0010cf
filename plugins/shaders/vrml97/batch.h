// batch.h: support for the batch loops of the VRML97 plug-in: function clones for several
// instruction sets, and elementary functions that the compiler can vectorise. All are pure
// functions. [render]
//
// Loops run over n rounded up to whole vectors, as the ABI allows, so none has a remainder.
// Contraction is off and no lane calls libm, so every clone gives the same bytes.
#pragma once

#include <cstdint>
#include <cstring>

#include "openrt/openrts.h"

// One function, compiled for several instruction sets, chosen when the plug-in is loaded.
// Sanitizers cannot run in the resolver that makes the choice, and other compilers get plain code.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) &&    \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VRML97_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define VRML97_CLONES
#endif
// Helpers must be inlined into the clones; a call would run code for the baseline instruction set.
#define VRML97_INLINE [[gnu::always_inline]] inline

namespace vrml97 {

VRML97_INLINE uint32_t wholeLanes(uint32_t n) {
  return (n + RTS_LANES - 1) / RTS_LANES * RTS_LANES;
}

VRML97_INLINE float larger(float a, float b) { return a > b ? a : b; }  // b where a is NaN
VRML97_INLINE float smaller(float a, float b) { return a < b ? a : b; } // b where a is NaN

// The arrays of n vectors. No other pointer of a loop leads to them, so the loop can be vectorised.
// GCC knows this only if the struct is a parameter by value.
struct VectorArrays {
  float* __restrict x;
  float* __restrict y;
  float* __restrict z;
};
struct ConstVectorArrays {
  const float* __restrict x;
  const float* __restrict y;
  const float* __restrict z;
};
VRML97_INLINE VectorArrays arraysOf(float* const v[3]) { return {v[0], v[1], v[2]}; }
VRML97_INLINE ConstVectorArrays constArraysOf(const float* const v[3]) {
  return {v[0], v[1], v[2]};
}

VRML97_INLINE uint32_t bitsOf(float x) { return __builtin_bit_cast(uint32_t, x); }
VRML97_INLINE float floatOf(uint32_t bits) { return __builtin_bit_cast(float, bits); }

VRML97_INLINE float squareRoot(float x) { return __builtin_sqrtf(x); }

// Returns the natural logarithm of 1 - s for 0 <= s < 1, with a relative error of about 1e-7. For
// small s it does not compute the difference. Polynomial of Cephes' logf (Moshier) on [sqrt(1/2),
// sqrt(2)].
VRML97_INLINE float logOneMinus(float s) {
  const float y = larger(1.0f - s, 1e-37f);
  const uint32_t shifted = bitsOf(y) - 0x3f3504f3u; // exponent steps at sqrt(1/2)
  const int32_t exponent = static_cast<int32_t>(shifted) >> 23;
  const float mantissa = floatOf((shifted & 0x7fffffu) + 0x3f3504f3u);
  const float x = exponent == 0 ? -s : mantissa - 1.0f;
  const float z = x * x;
  float p = 7.0376836292e-2f;
  p = p * x - 1.1514610310e-1f;
  p = p * x + 1.1676998740e-1f;
  p = p * x - 1.2420140846e-1f;
  p = p * x + 1.4249322787e-1f;
  p = p * x - 1.6668057665e-1f;
  p = p * x + 2.0000714765e-1f;
  p = p * x - 2.4999993993e-1f;
  p = p * x + 3.3333331174e-1f;
  const float e = static_cast<float>(exponent);
  return (p * x * z - 0.5f * z + e * -2.12194440e-4f) + x + e * 0.693359375f;
}

// expNegative() returns 0 for this and for anything below. Callers select between exponents, not
// between results: GCC turns a choice of results into a branch, and the loop stays scalar.
inline constexpr float vanishing = -88.0f;

// Returns e to the power x for x <= 0. Returns 0 for NaN and if the result is below the smallest
// normal number: the bits of the power of two are then all zero. Polynomial of Cephes' expf
// (Moshier).
VRML97_INLINE float expNegative(float x) {
  const float safe = larger(x, vanishing);
  const float k = safe * 1.44269504088896341f - 0.5f;
  // Truncation of a negative number minus 0.5 rounds the number to nearest.
  const int32_t whole = static_cast<int32_t>(k);
  const float e = static_cast<float>(whole);
  const float r = (safe - e * 0.693359375f) + e * 2.12194440e-4f;
  float p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  const float m = p * (r * r) + r + 1.0f;
  const float power = floatOf(static_cast<uint32_t>(whole + 127) << 23);
  return m * power;
}

// Returns the angle 0..pi between the vector (x, y), y >= 0, and the x axis; 0 for the zero vector.
// Polynomial of Cephes' atanf (Moshier).
VRML97_INLINE float angleOf(float x, float y) {
  const float ax = x < 0.0f ? -x : x;
  const bool steep = y > ax;
  const float small = steep ? ax : y;
  const float large = steep ? y : ax;
  const float t = small / larger(large, 1e-37f);
  const bool upper = t > 0.41421356237f; // tan(pi/8)
  const float r = upper ? (t - 1.0f) / (t + 1.0f) : t;
  const float z = r * r;
  float p = 8.05374449538e-2f;
  p = p * z - 1.38776856032e-1f;
  p = p * z + 1.99777106478e-1f;
  p = p * z - 3.33329491539e-1f;
  float a = p * z * r + r;
  a = upper ? a + 0.785398163397f : a;
  a = steep ? 1.57079632679f - a : a;
  return x < 0.0f ? 3.14159265359f - a : a;
}

} // namespace vrml97
