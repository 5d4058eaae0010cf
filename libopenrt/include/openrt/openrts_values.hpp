// openrts_values.hpp: vectors, colours, local frames, Fresnel reflectance and shader parameters.
// Included by openrts.hpp. The functions are pure. [any thread]
#ifndef OPENRT_OPENRTS_VALUES_HPP
#define OPENRT_OPENRTS_VALUES_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "openrts.h"

namespace rts {

// Values ------------------------------------------------------------------------------------------

// F is float, or Lanes: the values of several hits (openrts_lanes.hpp).
template <class F> struct Vec2Of { F x = 0, y = 0; };
template <class F> struct Vec3Of { F x = 0, y = 0, z = 0; };
template <class F> struct Vec4Of { F x = 0, y = 0, z = 0, w = 0; };
template <class F> struct ColorOf { // linear RGB
  F r = 0, g = 0, b = 0;
};
using Vec2 = Vec2Of<float>;
using Vec3 = Vec3Of<float>;
using Vec4 = Vec4Of<float>;
using Color = ColorOf<float>;
struct Matrix { // column-major
  float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};
struct Texture {
  RtsTexture id = 0;
};
using Floats = RtsFloats;
using String = const char*;

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(float s, Vec3 a) { return a * s; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { // returns the zero vector unchanged
  const float l = length(a);
  return l > 0 ? a * (1 / l) : a;
}
inline Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Color operator*(Color a, float s) { return {a.r * s, a.g * s, a.b * s}; }
inline Color operator*(float s, Color a) { return a * s; }

inline Color operator-(Color a, Color b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
inline Color operator/(Color a, float s) { return a * (1 / s); }
inline float largest(Color c) { return std::fmax(c.r, std::fmax(c.g, c.b)); }
inline constexpr float pi = 3.14159265358979f;

// An orthonormal basis (s, t, n) whose third axis is the given unit normal. It is a fixed frame,
// reflected at the plane between its third axis and -normal. It is continuous except at one normal,
// a direction that few surfaces face: pictures are noisier where a frame jumps.
struct Frame {
  explicit Frame(Vec3 normal) : n(normal) {
    constexpr Vec3 pole{-0.664998269f, -0.11246118f, 0.738329049f};
    constexpr Vec3 first{0.745604724f, -0.0430220561f, 0.664998269f},
        second{-0.0430220561f, 0.992724325f, 0.11246118f};
    const Vec3 v = n + pole;
    const float square = dot(v, v), scale = square > 0 ? 2 / square : 0;
    s = first - scale * dot(n, first) * v;
    t = second - scale * dot(n, second) * v;
    if (square > 0.01f) return;
    s = s - dot(s, n) * n; // orthogonalise again: the division above lost digits
    s = s * (1 / std::sqrt(dot(s, s)));
    t = {n.y * s.z - n.z * s.y, n.z * s.x - n.x * s.z, n.x * s.y - n.y * s.x};
  }
  Vec3 toLocal(Vec3 v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 toWorld(Vec3 v) const { return s * v.x + t * v.y + n * v.z; }
  Vec3 s, t, n;
};

// Returns the mirror direction of a direction that points towards a surface. normal: unit.
inline Vec3 reflect(Vec3 direction, Vec3 normal) {
  return direction - 2 * dot(direction, normal) * normal;
}

// Returns the Fresnel reflectance (0..1) of unpolarised light at the boundary of a clear medium (M.
// Born, E. Wolf, "Principles of Optics", 1.5.2).
//   cosine        cosine of the angle of incidence, 0..1
//   eta           index of refraction on the ray's side over that on the far side
//   cosineBehind  receives the cosine of the angle of refraction, 0 at total internal reflection
// In double precision, because near the critical angle the square root loses half of the digits.
inline double fresnel(double cosine, double eta, double* cosineBehind = nullptr) {
  const double sine2 = eta * eta * std::fmax(0.0, 1 - cosine * cosine),
               behind = sine2 < 1 ? std::sqrt(1 - sine2) : 0;
  if (cosineBehind) *cosineBehind = behind;
  if (!(sine2 < 1)) return 1;
  const double s = (eta * cosine - behind) / (eta * cosine + behind),
               p = (cosine - eta * behind) / (cosine + eta * behind);
  return (s * s + p * p) / 2;
}

// Parameters --------------------------------------------------------------------------------------

// How often the value of a parameter may change: per shader, or also per triangle or per vertex
// (interpolated at the hit). The last two are for numbers other than int32_t only.
enum class Frequency : uint8_t {};
inline constexpr Frequency PerShader{RTS_PER_SHADER}, PerTriangle{RTS_PER_TRIANGLE},
    PerVertex{RTS_PER_VERTEX};

namespace detail {

template <class T> struct ParamType;
template <> struct ParamType<int32_t> { static constexpr RtsType type = RTS_INT; };
template <> struct ParamType<float> { static constexpr RtsType type = RTS_FLOAT; };
template <> struct ParamType<Vec2> { static constexpr RtsType type = RTS_VEC2; };
template <> struct ParamType<Vec3> { static constexpr RtsType type = RTS_VEC3; };
template <> struct ParamType<Vec4> { static constexpr RtsType type = RTS_VEC4; };
template <> struct ParamType<Color> { static constexpr RtsType type = RTS_COLOR; };
template <> struct ParamType<Matrix> { static constexpr RtsType type = RTS_MATRIX; };
template <> struct ParamType<Floats> { static constexpr RtsType type = RTS_FLOATS; };
template <> struct ParamType<String> { static constexpr RtsType type = RTS_STRING; };
template <> struct ParamType<Texture> { static constexpr RtsType type = RTS_TEXTURE; };

// Collects the parameters of a class while its prototype is constructed: each Param records its
// offset.
struct Declaration {
  std::vector<RtsParam> params;
  std::vector<uint8_t> frequency;
  const char* start = nullptr;
};
inline Declaration*& declaration() {
  static thread_local Declaration* current = nullptr;
  return current;
}

inline void declare(const char* name, RtsType type, const void* place, const void* value,
                    size_t bytes, const char* text, float minimum, float maximum,
                    Frequency frequency) {
  Declaration* d = declaration();
  if (!d) return;
  RtsParam p{};
  p.name = name;
  p.type = type;
  p.offset = static_cast<uint32_t>(static_cast<const char*>(place) - d->start);
  if (type == RTS_INT) {
    int32_t whole = 0;
    std::memcpy(&whole, value, sizeof whole);
    p.defaultValue[0] = static_cast<float>(whole);
  } else if (type >= RTS_FLOAT && type <= RTS_MATRIX) {
    std::memcpy(p.defaultValue, value, bytes);
  }
  p.minimum = minimum;
  p.maximum = maximum;
  p.text = text;
  d->params.push_back(p);
  d->frequency.push_back(static_cast<uint8_t>(frequency));
}

} // namespace detail

// A parameter: name, default value, a line that says meaning and unit, and optionally an inclusive
// range (0, 0: none) and a frequency. Converts to its value. Lists, strings and textures start
// empty.
template <class T> class Param {
 public:
  Param(const char* name, T value, const char* text, float minimum = 0, float maximum = 0,
        Frequency frequency = PerShader)
      : value_(value) {
    detail::declare(name, detail::ParamType<T>::type, &value_, &value_, sizeof value_, text,
                    minimum, maximum, frequency);
  }
  Param(const char* name, T value, const char* text, Frequency frequency)
      : Param(name, value, text, 0, 0, frequency) {}
  Param(const char* name, const char* text) : Param(name, T(), text) {}
  operator const T&() const { return value_; }
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }

 private:
  T value_; // the only member: the host writes the value here
};

} // namespace rts

#endif
