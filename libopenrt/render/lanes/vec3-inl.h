// vec3-inl.h: a vector whose three components are vector lanes. The names are those of
// scene/vec3.h, which has the vectors of single numbers. Lanes need functions that are compiled for
// each instruction set, so lanes-inl.h includes this text once in the namespace of each. Pure
// functions. [any thread]

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

// The rows of a linear map.
template <class T> struct Rows { Vec3<T> x, y, z; };
template <class T> inline Vec3<T> operator*(const Rows<T>& m, const Vec3<T>& v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
