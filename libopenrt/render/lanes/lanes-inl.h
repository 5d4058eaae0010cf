// lanes-inl.h: vector lanes (common/vector_lanes-inl.h) and the renderer's arrays: `Bits` holds as
// many 32-bit integers as `Lanes` holds floats. Arrays of the renderer are padded to 16 elements
// (arena.h), which every width divides, so loops over them have no remainder. Included by files
// that Highway compiles once for each instruction set.

#if defined(OPENRT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LANES_INL_H
#undef OPENRT_LANES_INL_H
#else
#define OPENRT_LANES_INL_H
#endif

#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "render/arena.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

#include "vector_lanes-inl.h"

using BitsTag = hn::CappedTag<uint32_t, 16>;
using Bits = hn::Vec<BitsTag>;
using BitsMask = hn::Mask<BitsTag>;
inline uint32_t width() { return uint32_t(hn::Lanes(LanesTag())); }

inline Bits bitsOf(uint32_t value) { return hn::Set(BitsTag(), value); }
inline Bits load(const uint32_t* from) { return hn::LoadU(BitsTag(), from); }
inline void store(Bits v, uint32_t* to) { hn::StoreU(v, BitsTag(), to); }

// Returns v where it is finite and above 0, else 0.
inline Lanes checked(Lanes v) {
  return hn::IfThenElseZero(hn::And(v > lanesOf(0), isFinite(v)), v);
}
inline Bits bitsOfFloat(Lanes v) { return hn::BitCast(BitsTag(), v); }
inline Lanes floatOfBits(Bits v) { return hn::BitCast(LanesTag(), v); }
// Convert conditions between lanes and bits.
inline Mask maskOf(BitsMask condition) { return hn::RebindMask(LanesTag(), condition); }
inline BitsMask maskOf(Mask condition) { return hn::RebindMask(BitsTag(), condition); }
// Returns `bits` where the condition holds, else 0.
inline Bits bitsWhere(Mask condition, uint32_t bits) {
  return hn::IfThenElseZero(maskOf(condition), bitsOf(bits));
}

// The rows of a linear map.
template <class T> struct Rows { Vec3<T> x, y, z; };
template <class T> inline Vec3<T> operator*(const Rows<T>& m, const Vec3<T>& v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}

inline LaneVec checked(const LaneVec& v) { return {checked(v.x), checked(v.y), checked(v.z)}; }
inline LaneVec vectorOf(const float v[3]) { return {lanesOf(v[0]), lanesOf(v[1]), lanesOf(v[2])}; }
// Load and store the elements from i on of three arrays.
inline LaneVec load(const float* const from[3], size_t i) {
  return {load(from[0] + i), load(from[1] + i), load(from[2] + i)};
}
inline void store(const LaneVec& v, float* const to[3], size_t i) {
  store(v.x, to[0] + i);
  store(v.y, to[1] + i);
  store(v.z, to[2] + i);
}

// The same for three consecutive arrays of 16 elements.
inline LaneVec load(const float (*from)[lanes], size_t i) {
  return {load(from[0] + i), load(from[1] + i), load(from[2] + i)};
}
inline void store(const LaneVec& v, float (*to)[lanes], size_t i) {
  store(v.x, to[0] + i);
  store(v.y, to[1] + i);
  store(v.z, to[2] + i);
}
inline Rows<Lanes> load(const float (*from)[3][lanes], size_t i) {
  return {load(from[0], i), load(from[1], i), load(from[2], i)};
}

// Load and store at most `count` elements, for arrays that are not padded.
inline Lanes loadSome(const float* from, uint32_t count) {
  if (count >= width()) return load(from);
  float some[lanes] = {};
  for (uint32_t k = 0; k < count; k++) some[k] = from[k];
  return load(some);
}
inline Bits loadSome(const uint32_t* from, uint32_t count) {
  if (count >= width()) return load(from);
  uint32_t some[lanes] = {};
  for (uint32_t k = 0; k < count; k++) some[k] = from[k];
  return load(some);
}
inline void storeSome(Lanes v, float* to, uint32_t count) {
  if (count >= width()) return store(v, to);
  float some[lanes];
  store(v, some);
  for (uint32_t k = 0; k < count; k++) to[k] = some[k];
}
inline LaneVec loadSome(const float* const from[3], size_t i, uint32_t count) {
  return {loadSome(from[0] + i, count), loadSome(from[1] + i, count), loadSome(from[2] + i, count)};
}
inline void storeSome(const LaneVec& v, float* const to[3], size_t i, uint32_t count) {
  storeSome(v.x, to[0] + i, count);
  storeSome(v.y, to[1] + i, count);
  storeSome(v.z, to[2] + i, count);
}

// Loads the indices from i on of an array of n. Lanes beyond its end repeat its last index.
inline Indices indicesFrom(const uint32_t* index, uint32_t i, uint32_t n) {
  const IndicesTag tag;
  if (i + width() <= n) return hn::BitCast(tag, load(index + i));
  uint32_t last[lanes];
  for (uint32_t k = 0; k < width(); k++) last[k] = index[i + k < n ? i + k : n - 1];
  return hn::BitCast(tag, load(last));
}
inline LaneVec gather(const float* const from[3], Indices index) {
  return {gather(from[0], index), gather(from[1], index), gather(from[2], index)};
}
inline Bits gather(const uint32_t* from, Indices index) {
  const auto* const numbers = reinterpret_cast<const int32_t*>(from);
  return hn::BitCast(BitsTag(), hn::GatherIndex(IndicesTag(), numbers, index));
}

// Returns the lanes of element i to element n - 1 of an array whose first vector starts at i.
inline Mask presentFrom(uint32_t i, uint32_t n) { return hn::FirstN(LanesTag(), n - i); }
inline Mask noLanes() { return hn::FirstN(LanesTag(), 0); }
// Returns where any of the given bits is set.
inline Mask hasBits(Bits v, uint32_t bits) {
  return maskOf(hn::Ne(hn::And(v, bitsOf(bits)), bitsOf(0)));
}
// Returns where the array is not 0.
inline Mask loadMask(const uint32_t* from) { return hasBits(load(from), ~0u); }

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
