// directions-inl.h: frames and sampled directions of vector lanes: the formulas of
// render/orthonormal_basis.h and render/surface/scatter.h.

#if defined(OPENRT_LANES_DIRECTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LANES_DIRECTIONS_INL_H
#undef OPENRT_LANES_DIRECTIONS_INL_H
#else
#define OPENRT_LANES_DIRECTIONS_INL_H
#endif

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// Moves points off their surfaces: offsetPoint() of render/wave/points.h.
inline LaneVec offsetPoint(const LaneVec& p, const LaneVec& n, Lanes error) {
  const auto along = [](Lanes place, Lanes step) {
    const Lanes zero = lanesOf(0), moved = place + step;
    const Bits bits = bitsOfFloat(moved), one = bitsOf(1);
    const Mask outward = hn::Not(hn::Xor(step > zero, moved > zero));
    const Lanes next =
        select(outward, floatOfBits(hn::Add(bits, one)), floatOfBits(hn::Sub(bits, one)));
    return select(step != zero, select(moved != zero, next, step), moved);
  };
  return {along(p.x, n.x * error), along(p.y, n.y * error), along(p.z, n.z * error)};
}

// Reflects directions that point towards the surface, at normals: reflectAt() of
// render/surface/scatter.h, and so on below.
template <class V> inline Vec3<V> reflectAt(const Vec3<V>& d, const Vec3<V>& n) {
  return d - (constant<V>(2) * dot(d, n)) * n;
}

// Returns the Fresnel reflectance. V: lanes of double.
template <class V> inline V fresnel(V cosine, V eta, V& cosineBehind) {
  const V zero = constant<V>(0), one = constant<V>(1);
  const V sineBehind2 = eta * eta * max(zero, one - cosine * cosine);
  const auto total = sineBehind2 >= one;
  cosineBehind = select(total, zero, sqrt(one - sineBehind2));
  const V s = (eta * cosine - cosineBehind) / (eta * cosine + cosineBehind);
  const V p = (cosine - eta * cosineBehind) / (cosine + eta * cosineBehind);
  return select(total, one, (s * s + p * p) / constant<V>(2));
}

// Refracts directions by Snell's law. V: lanes of double.
template <class V>
inline Vec3<V> refractAt(const Vec3<V>& d, const Vec3<V>& n, V eta, V cosine, V cosineBehind) {
  const Vec3<V> r = eta * d + (eta * cosine - cosineBehind) * n;
  const V square = dot(r, r), zero = constant<V>(0);
  return r * select(square > zero, constant<V>(1) / sqrt(square), zero);
}

// Completes unit vectors to right-handed orthonormal frames s, t, n: basisOf() of
// render/orthonormal_basis.h.
inline void basisOf(const LaneVec& n, LaneVec& s, LaneVec& t) {
  const auto vector = [](float x, float y, float z) {
    return LaneVec{lanesOf(x), lanesOf(y), lanesOf(z)};
  };
  const LaneVec pole = vector(-0.66499826946907159f, -0.11246117974981107f, 0.73832904903736574f),
                first = vector(0.74560472389174559f, -0.043022056127687142f, 0.66499826946907159f),
                second = vector(-0.043022056127687142f, 0.99272432514562003f, 0.11246117974981107f);
  const Lanes zero = lanesOf(0);
  const LaneVec v = n + pole;
  const Lanes square = dot(v, v), scale = select(square > zero, lanesOf(2) / square, zero);
  s = first - v * (scale * dot(n, first));
  t = second - v * (scale * dot(n, second));
  // Near the jump the sum has lost digits, so the frame is made orthogonal again.
  const Mask near = square <= lanesOf(0.01f);
  if (hn::AllFalse(LanesTag(), near)) return;
  const LaneVec across = s - n * dot(s, n);
  const LaneVec unit = across * (lanesOf(1) / sqrt(dot(across, across)));
  s = select(near, unit, s);
  t = select(near, cross(n, unit), t);
}

// Return sine and cosine of angles between -pi/4 and pi/4 by their power series.
inline Lanes sineSmall(Lanes x) {
  const Lanes s = x * x;
  return x * (lanesOf(1) + s * (lanesOf(-1.0f / 6) +
                                s * (lanesOf(1.0f / 120) +
                                     s * (lanesOf(-1.0f / 5040) + s * lanesOf(1.0f / 362880)))));
}
inline Lanes cosineSmall(Lanes x) {
  const Lanes s = x * x;
  return lanesOf(1) + s * (lanesOf(-0.5f) +
                           s * (lanesOf(1.0f / 24) +
                                s * (lanesOf(-1.0f / 720) +
                                     s * (lanesOf(1.0f / 40320) + s * lanesOf(-1.0f / 3628800)))));
}

// Samples directions about n with pdf cosine / pi: the concentric disc mapping of P. Shirley, K.
// Chiu (1997), lifted to the hemisphere.
inline LaneVec sampleCosineHemisphere(const LaneVec& n, Lanes u, Lanes v) {
  const Lanes zero = lanesOf(0), one = lanesOf(1), two = lanesOf(2);
  const Lanes a = two * u - one, b = two * v - one;
  const Mask wide = abs(a) > abs(b); // within an eighth of a turn of the x axis
  const Lanes r = select(wide, a, b), other = select(wide, b, a);
  const Lanes ratio = select(r != zero, other / select(r != zero, r, one), zero);
  const Lanes angle = lanesOf(0.785398163f) * ratio;
  const Lanes along = r * cosineSmall(angle), across = r * sineSmall(angle);
  const Lanes x = select(wide, along, across), y = select(wide, across, along),
              z = sqrt(max(zero, one - x * x - y * y));
  LaneVec s, t;
  basisOf(n, s, t);
  return s * x + t * y + n * z;
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
