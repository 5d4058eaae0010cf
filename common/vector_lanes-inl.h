// vector_lanes-inl.h: vector lanes: `Lanes` holds as many floats as the instruction set computes at
// once, at most 16; `LaneVec` is a vector whose three components are lanes. Lanes need functions
// that are compiled for each instruction set. So lanes-inl.h of libopenrt/render/lanes and that of
// libpicture/live include this text once, in the namespace that Highway has for each
// (https://google.github.io/highway). All else has Highway's names. Pure functions.
// [any thread]
//
// All instruction sets give the same numbers: the operations are correctly rounded, products and
// sums are not fused, and there is no sum across lanes (docs/decisions/0046-vector-lanes.md).

namespace hn = hwy::HWY_NAMESPACE;

using LanesTag = hn::CappedTag<float, 16>;
using IndicesTag = hn::RebindToSigned<LanesTag>;
using Lanes = hn::Vec<LanesTag>;
using Indices = hn::Vec<IndicesTag>; // indices into arrays
using Mask = hn::Mask<LanesTag>;

inline Lanes lanesOf(float value) { return hn::Set(LanesTag(), value); }
inline Lanes load(const float* from) { return hn::LoadU(LanesTag(), from); }
inline void store(Lanes v, float* to) { hn::StoreU(v, LanesTag(), to); }
inline Lanes gather(const float* from, Indices index) {
  return hn::GatherIndex(LanesTag(), from, index);
}

// These work with vectors of any width.
template <class M, class V> inline V select(M condition, V a, V b) {
  return hn::IfThenElse(condition, a, b);
}
template <class V> inline V constant(float value) { return hn::Set(hn::DFromV<V>(), value); }
template <class V> inline V sqrt(V v) { return hn::Sqrt(v); }
template <class V> inline V abs(V v) { return hn::Abs(v); }
// Like std::max and std::min, also with NaN: the result is `a` unless the comparison holds.
template <class V> inline V max(V a, V b) { return hn::IfThenElse(a < b, b, a); }
template <class V> inline V min(V a, V b) { return hn::IfThenElse(b < a, b, a); }
inline Mask isFinite(Lanes v) { return hn::Abs(v) <= lanesOf(std::numeric_limits<float>::max()); }

// The names are those of libopenrt/scene/vec3.h, which has the vectors of single numbers.
template <class T> struct Vec3 { T x, y, z; };

template <class T> inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
// Multiplies component by component.
template <class T> inline Vec3<T> operator*(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T> inline Vec3<T> operator*(const Vec3<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T> inline Vec3<T> operator*(T s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T> inline T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> inline T largest(const Vec3<T>& a) { return max(max(a.x, a.y), a.z); }
template <class T> inline Vec3<T> abs(const Vec3<T>& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
// Returns a component by component where the condition holds, else b.
template <class M, class T> inline Vec3<T> select(M condition, const Vec3<T>& a, const Vec3<T>& b) {
  return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}

using LaneVec = Vec3<Lanes>;
