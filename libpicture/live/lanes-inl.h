// lanes-inl.h: Vectors of floats in the instruction set of the machine, for files that Highway
// compiles once for each instruction set (https://google.github.io/highway;
// docs/decisions/0046-vector-lanes.md). All instruction sets give the same numbers: operations are
// rounded correctly, products and sums are not fused, and there is no sum across lanes.

#if defined(PICTURE_LIVE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PICTURE_LIVE_LANES_INL_H
#undef PICTURE_LIVE_LANES_INL_H
#else
#define PICTURE_LIVE_LANES_INL_H
#endif

#include <algorithm>
#include <limits>

#include <hwy/highway.h>

#include "libpicture/live/planes.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, Layout::widest>;
using IndexTag = hn::RebindToSigned<Tag>;
using Lanes = hn::Vec<Tag>;
using Index = hn::Vec<IndexTag>;
using Mask = hn::Mask<Tag>;

inline int width() { return int(hn::Lanes(Tag())); }
inline Lanes all(float value) { return hn::Set(Tag(), value); }
inline Lanes load(const float* from) { return hn::LoadU(Tag(), from); }
inline void store(Lanes v, float* to) { hn::StoreU(v, Tag(), to); }
inline Lanes select(Mask condition, Lanes a, Lanes b) { return hn::IfThenElse(condition, a, b); }
inline Lanes where(Mask condition, Lanes v) { return hn::IfThenElseZero(condition, v); }
inline Mask both(Mask a, Mask b) { return hn::And(a, b); }
inline Mask either(Mask a, Mask b) { return hn::Or(a, b); }
inline Lanes absolute(Lanes v) { return hn::Abs(v); }
// Return `a` unless the comparison holds, also with NaN.
inline Lanes larger(Lanes a, Lanes b) { return hn::IfThenElse(a < b, b, a); }
inline Lanes smaller(Lanes a, Lanes b) { return hn::IfThenElse(b < a, b, a); }
inline Lanes clamped(Lanes v, Lanes low, Lanes high) { return smaller(larger(v, low), high); }
inline Mask isFinite(Lanes v) { return hn::Abs(v) <= all(std::numeric_limits<float>::max()); }
// Returns the lanes that hold the pixels from x on of a row of n.
inline Mask present(int x, int n) { return hn::FirstN(Tag(), size_t(std::max(0, n - x))); }
// Returns x, x + 1, x + 2 ...
inline Lanes countFrom(int x) { return hn::Iota(Tag(), float(x)); }
inline Lanes gather(const float* from, Index index) { return hn::GatherIndex(Tag(), from, index); }

struct Lanes3 {
  Lanes x, y, z;
};
inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes3 operator*(const Lanes3& a, Lanes b) { return {a.x * b, a.y * b, a.z * b}; }
inline Lanes3 operator*(const Lanes3& a, const Lanes3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes3 select(Mask condition, const Lanes3& a, const Lanes3& b) {
  return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}
inline Lanes3 load(const Plane3& from, size_t i) {
  return {load(from.x.data() + i), load(from.y.data() + i), load(from.z.data() + i)};
}
inline void store(const Lanes3& v, Plane3& to, size_t i) {
  store(v.x, to.x.data() + i);
  store(v.y, to.y.data() + i);
  store(v.z, to.z.data() + i);
}
inline Lanes3 gather(const Plane3& from, Index index) {
  return {gather(from.x.data(), index), gather(from.y.data(), index), gather(from.z.data(), index)};
}

// Returns the elements from i on of an array of n; 0 behind its end.
inline Lanes loadSome(const float* from, int i, int n) {
  if (i + width() <= n) return load(from + i);
  float some[Layout::widest] = {};
  std::copy(from + std::min(i, n), from + n, some);
  return load(some);
}
// The same for an array of n times three numbers.
inline Lanes3 loadTriples(const float* from, int i, int n) {
  Lanes3 v;
  if (i + width() <= n) {
    hn::LoadInterleaved3(Tag(), from + 3 * i, v.x, v.y, v.z);
    return v;
  }
  float some[3 * Layout::widest] = {};
  std::copy(from + 3 * std::min(i, n), from + 3 * n, some);
  hn::LoadInterleaved3(Tag(), some, v.x, v.y, v.z);
  return v;
}
// The same for an array of n times four numbers; w receives the fourth.
inline Lanes3 loadQuadruples(const float* from, int i, int n, Lanes& w) {
  Lanes3 v;
  if (i + width() <= n) {
    hn::LoadInterleaved4(Tag(), from + 4 * i, v.x, v.y, v.z, w);
    return v;
  }
  float some[4 * Layout::widest] = {};
  std::copy(from + 4 * std::min(i, n), from + 4 * n, some);
  hn::LoadInterleaved4(Tag(), some, v.x, v.y, v.z, w);
  return v;
}

// Returns about exp(-v) for v from 0 on: a power of a straight line, without a branch, and 0 from
// 16 on.
inline Lanes fallOff(Lanes v) {
  const Lanes a = larger(all(1) - v * all(1.0f / 16), all(0));
  const Lanes a2 = a * a, a4 = a2 * a2, a8 = a4 * a4;
  return a8 * a8;
}

// Between colours and luma with differences (Y Co Cg): luma is what variance and edges are judged
// by.
inline Lanes3 lumaOf(const Lanes3& rgb) {
  const Lanes half = all(0.5f), quarter = all(0.25f);
  return {rgb.x * quarter + rgb.y * half + rgb.z * quarter, (rgb.x - rgb.z) * half,
          rgb.y * half - (rgb.x + rgb.z) * quarter};
}
inline Lanes3 colourOf(const Lanes3& luma) {
  const Lanes rest = luma.x - luma.z;
  return {rest + luma.y, luma.x + luma.z, rest - luma.y};
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#endif
