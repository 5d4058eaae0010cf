// math-inl.h: sine, cosine and arctangent of vector lanes. All instruction sets give the same
// numbers, which the functions of the C library do not promise. Polynomials: S. Moshier, Cephes
// Mathematical Library (sinf, cosf, atanf). Pure functions. [any thread]

#if defined(OPENRT_LANES_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LANES_MATH_INL_H
#undef OPENRT_LANES_MATH_INL_H
#else
#define OPENRT_LANES_MATH_INL_H
#endif

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// Computes sine and cosine of angles between -100 and 100, with an absolute error below 1.2e-7.
inline void sinCos(Lanes x, Lanes& sine, Lanes& cosine) {
  const Lanes quarter = hn::Round(x * lanesOf(0.636619772f)); // 2 / pi
  // pi / 2 in three parts with few digits, so that the products are exact.
  const Lanes r = x - quarter * lanesOf(1.5703125f) - quarter * lanesOf(4.8375129699707e-4f) -
                  quarter * lanesOf(7.5497899548918821e-8f);
  const Lanes z = r * r;
  const Lanes s = r + r * z *
                          (lanesOf(-1.6666654611e-1f) +
                           z * (lanesOf(8.3321608736e-3f) + z * lanesOf(-1.9515295891e-4f)));
  const Lanes c = lanesOf(1) - z * lanesOf(0.5f) +
                  z * z *
                      (lanesOf(4.166664568298827e-2f) +
                       z * (lanesOf(-1.388731625493765e-3f) + z * lanesOf(2.443315711809948e-5f)));
  const hn::RebindToSigned<LanesTag> integers;
  const auto q = hn::ConvertTo(integers, quarter);
  const Mask odd =
      hn::RebindMask(LanesTag(), hn::Ne(hn::And(q, hn::Set(integers, 1)), hn::Zero(integers)));
  const Lanes a = select(odd, c, s), b = select(odd, s, c);
  const auto second = hn::Set(integers, 2), one = hn::Set(integers, 1);
  const Mask negativeSine =
      hn::RebindMask(LanesTag(), hn::Ne(hn::And(q, second), hn::Zero(integers)));
  const Mask negativeCosine =
      hn::RebindMask(LanesTag(), hn::Ne(hn::And(hn::Add(q, one), second), hn::Zero(integers)));
  sine = select(negativeSine, lanesOf(0) - a, a);
  cosine = select(negativeCosine, lanesOf(0) - b, b);
}

// Returns the angle of the point (x, y) with y >= 0, between 0 and pi, with a relative error below
// 3e-7.
inline Lanes atan2Positive(Lanes y, Lanes x) {
  const Lanes size = abs(x);
  const Mask steep = y > size;
  const Lanes t = select(steep, size, y) / select(steep, y, size);
  const Mask large = t > lanesOf(0.4142135624f); // tan(pi / 8)
  const Lanes u = select(large, (t - lanesOf(1)) / (t + lanesOf(1)), t), z = u * u;
  const Lanes p = u + u * z *
                          (lanesOf(-3.33329491539e-1f) +
                           z * (lanesOf(1.99777106478e-1f) + z * (lanesOf(-1.38776856032e-1f) +
                                                                  z * lanesOf(8.05374449538e-2f))));
  Lanes angle = select(large, p + lanesOf(0.785398163397448f), p);
  angle = select(steep, lanesOf(1.57079632679490f) - angle, angle);
  return select(x < lanesOf(0), lanesOf(3.14159265358979f) - angle, angle);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
