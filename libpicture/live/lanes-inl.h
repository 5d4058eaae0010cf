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

#include "vector_lanes-inl.h"

inline int width() { return int(hn::Lanes(LanesTag())); }
static_assert(hn::MaxLanes(LanesTag()) <= Layout::widest);

inline Lanes clamp(Lanes v, Lanes low, Lanes high) { return min(max(v, low), high); }
// Returns the lanes that hold the pixels from x on of a row of n.
inline Mask presentFrom(int x, int n) { return hn::FirstN(LanesTag(), size_t(std::max(0, n - x))); }
// Returns x, x + 1, x + 2 ...
inline Lanes countFrom(int x) { return hn::Iota(LanesTag(), float(x)); }

inline LaneVec load(const Plane3& from, size_t i) {
  return {load(from.x.data() + i), load(from.y.data() + i), load(from.z.data() + i)};
}
inline void store(const LaneVec& v, Plane3& to, size_t i) {
  store(v.x, to.x.data() + i);
  store(v.y, to.y.data() + i);
  store(v.z, to.z.data() + i);
}
inline LaneVec gather(const Plane3& from, Indices index) {
  return {gather(from.x.data(), index), gather(from.y.data(), index), gather(from.z.data(), index)};
}

// Returns the elements from i on of an array of n; 0 behind its end.
inline Lanes loadSome(const float* from, int i, int n) {
  if (i + width() <= n) return load(from + i);
  float some[Layout::widest] = {};
  std::copy(from + std::min(i, n), from + n, some);
  return load(some);
}
// The same for an array of n times two numbers; y receives the second.
inline Lanes loadPairs(const float* from, int i, int n, Lanes& y) {
  Lanes x;
  if (i + width() <= n) {
    hn::LoadInterleaved2(LanesTag(), from + 2 * i, x, y);
    return x;
  }
  float some[2 * Layout::widest] = {};
  std::copy(from + 2 * std::min(i, n), from + 2 * n, some);
  hn::LoadInterleaved2(LanesTag(), some, x, y);
  return x;
}
// The same for an array of n times three numbers.
inline LaneVec loadTriples(const float* from, int i, int n) {
  LaneVec v;
  if (i + width() <= n) {
    hn::LoadInterleaved3(LanesTag(), from + 3 * i, v.x, v.y, v.z);
    return v;
  }
  float some[3 * Layout::widest] = {};
  std::copy(from + 3 * std::min(i, n), from + 3 * n, some);
  hn::LoadInterleaved3(LanesTag(), some, v.x, v.y, v.z);
  return v;
}
// The same for an array of n times four numbers; w receives the fourth.
inline LaneVec loadQuadruples(const float* from, int i, int n, Lanes& w) {
  LaneVec v;
  if (i + width() <= n) {
    hn::LoadInterleaved4(LanesTag(), from + 4 * i, v.x, v.y, v.z, w);
    return v;
  }
  float some[4 * Layout::widest] = {};
  std::copy(from + 4 * std::min(i, n), from + 4 * n, some);
  hn::LoadInterleaved4(LanesTag(), some, v.x, v.y, v.z, w);
  return v;
}

// Returns about exp(-v) for v from 0 on: a power of a straight line, without a branch, and 0 from
// 16 on.
inline Lanes fallOff(Lanes v) {
  const Lanes a = max(lanesOf(1) - v * lanesOf(1.0f / 16), lanesOf(0));
  const Lanes a2 = a * a, a4 = a2 * a2, a8 = a4 * a4;
  return a8 * a8;
}

// Between colours and luma with differences (Y Co Cg): luma is what variance and edges are judged
// by.
inline LaneVec lumaOf(const LaneVec& rgb) {
  const Lanes half = lanesOf(0.5f), quarter = lanesOf(0.25f);
  return {rgb.x * quarter + rgb.y * half + rgb.z * quarter, (rgb.x - rgb.z) * half,
          rgb.y * half - (rgb.x + rgb.z) * quarter};
}
inline LaneVec colourOf(const LaneVec& luma) {
  const Lanes rest = luma.x - luma.z;
  return {rest + luma.y, luma.x + luma.z, rest - luma.y};
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#endif
