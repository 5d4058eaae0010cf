// openrts_lanes.hpp: numbers, vectors and colours of several hits at once, so that a shader's
// functions compute with vector instructions. Included by openrts.hpp. Pure functions. [any thread]
//
// A shader function that is a template over its numbers runs with Lanes; the same source with float
// computes one hit (docs/shaders.md, section 7). It chooses by `select` instead of branches, as
// hits of one group may differ:
//
//   template <class F> rts::IlluminationOf<F> illuminate(rts::Vec3Of<F> point) const {
//     const rts::Vec3Of<F> way = *location - point;
//     const F square = rts::dot(way, way);
//     return {way, *color * rts::select(square > 1e-30f, 1 / square, 0), {}};
//   }
//
// Lanes are as wide as the registers of the instruction set that the plug-in is compiled for.
// Compile all files of a plug-in for the same one. Every operation is that of IEEE 754 for each
// lane, so results have the same bytes for any width, and for float, under one condition: the
// compiler may not fuse products and sums (-ffp-contract=off, as openrt_add_shader() of CMake
// sets). -fno-math-errno is needed for vectors of square roots.
#ifndef OPENRT_OPENRTS_LANES_HPP
#define OPENRT_OPENRTS_LANES_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

#include "openrts_values.hpp"

namespace rts {

namespace detail {

#if defined(__GNUC__) && defined(__AVX512F__)
typedef float Vector __attribute__((vector_size(64)));
#elif defined(__GNUC__) && defined(__AVX__)
typedef float Vector __attribute__((vector_size(32)));
#elif defined(__GNUC__)
typedef float Vector __attribute__((vector_size(16)));
#else
using Vector = float; // other compilers: one lane
#endif
using Truths = decltype(Vector() < Vector()); // by lane: 0, or all bits set (one lane: a bool)

// Loads or stores one number (F = float), or a group of neighbouring numbers (F = Lanes).
template <class F> F load(const float* from) {
  F f;
  std::memcpy(static_cast<void*>(&f), from, sizeof f);
  return f;
}
template <class F> void store(float* to, F f) { std::memcpy(to, &f, sizeof f); }

} // namespace detail

// Floats ------------------------------------------------------------------------------------------

// Floats of neighbouring hits, one for each lane.
struct Lanes {
  // Number of lanes: 4, 8 or 16, a divisor of RTS_LANES; 1 for compilers without vectors.
  static constexpr uint32_t size = sizeof(detail::Vector) / sizeof(float);

  Lanes() : Lanes(0.0f) {}
  Lanes(float same) : v(same - detail::Vector()) {}
  static Lanes of(detail::Vector vector) {
    Lanes out;
    out.v = vector;
    return out;
  }
  static Lanes load(const float* from) { return detail::load<Lanes>(from); }
  void store(float* to) const { detail::store(to, *this); }
  float operator[](uint32_t lane) const {
    float at[size];
    store(at);
    return at[lane];
  }

  detail::Vector v;
};

// Truth values of neighbouring hits. Combine them by & and |.
struct Mask {
  Mask(bool same) : v(Lanes(float(same)).v > detail::Vector()) {}
  static Mask of(detail::Truths truths) {
    Mask out(false);
    out.v = truths;
    return out;
  }
  bool operator[](uint32_t lane) const { return Lanes::of(v ? Lanes(1).v : Lanes().v)[lane] != 0; }

  detail::Truths v;
};

inline Lanes operator+(Lanes a, Lanes b) { return Lanes::of(a.v + b.v); }
inline Lanes operator-(Lanes a, Lanes b) { return Lanes::of(a.v - b.v); }
inline Lanes operator*(Lanes a, Lanes b) { return Lanes::of(a.v * b.v); }
inline Lanes operator/(Lanes a, Lanes b) { return Lanes::of(a.v / b.v); }
inline Lanes operator-(Lanes a) { return Lanes::of(-a.v); }
inline Mask operator<(Lanes a, Lanes b) { return Mask::of(a.v < b.v); }
inline Mask operator>(Lanes a, Lanes b) { return Mask::of(a.v > b.v); }
inline Mask operator<=(Lanes a, Lanes b) { return Mask::of(a.v <= b.v); }
inline Mask operator>=(Lanes a, Lanes b) { return Mask::of(a.v >= b.v); }
inline Mask operator==(Lanes a, Lanes b) { return Mask::of(a.v == b.v); }
inline Mask operator!=(Lanes a, Lanes b) { return Mask::of(a.v != b.v); }
inline Mask operator&(Mask a, Mask b) { return Mask::of(detail::Truths(a.v & b.v)); }
inline Mask operator|(Mask a, Mask b) { return Mask::of(detail::Truths(a.v | b.v)); }
inline Mask operator!(Mask a) { return Mask::of(detail::Truths(a.v == detail::Truths())); }

// Returns a where the condition holds, else b. Both are computed.
inline float select(bool condition, float a, float b) { return condition ? a : b; }
inline Lanes select(Mask condition, Lanes a, Lanes b) { return Lanes::of(condition.v ? a.v : b.v); }

// Return the smaller or the larger number; b where either is NaN.
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }
inline Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }
inline Lanes larger(Lanes a, Lanes b) { return select(a > b, a, b); }

// Returns |a|; -0 stays -0.
inline float absolute(float a) { return a < 0 ? -a : a; }
inline Lanes absolute(Lanes a) { return select(a < 0, -a, a); }

inline float squareRoot(float a) { return std::sqrt(a); }
inline Lanes squareRoot(Lanes a) {
  float at[Lanes::size];
  a.store(at);
  for (float& x : at) x = std::sqrt(x); // compiles to one instruction
  return Lanes::load(at);
}

// Calls a function of floats lane by lane, for what has no vector form: std::pow, tables, integers.
template <class Function, class... Floats>
float eachLane(const Function& function, float first, Floats... rest) {
  return function(first, rest...);
}
template <class Function, class... More>
Lanes eachLane(const Function& function, Lanes first, More... rest) {
  float out[Lanes::size];
  for (uint32_t i = 0; i < Lanes::size; i++) out[i] = function(first[i], Lanes(rest)[i]...);
  return Lanes::load(out);
}

// Vectors and colours -----------------------------------------------------------------------------
// Those of one hit convert to them, so both can stand in one formula.

template <> struct Vec2Of<Lanes> {
  Vec2Of() = default;
  Vec2Of(Lanes x, Lanes y) : x(x), y(y) {}
  Vec2Of(Vec2 same) : x(same.x), y(same.y) {}
  Lanes x, y;
};
template <> struct Vec3Of<Lanes> {
  Vec3Of() = default;
  Vec3Of(Lanes x, Lanes y, Lanes z) : x(x), y(y), z(z) {}
  Vec3Of(Vec3 same) : x(same.x), y(same.y), z(same.z) {}
  Lanes x, y, z;
};
template <> struct Vec4Of<Lanes> {
  Vec4Of() = default;
  Vec4Of(Lanes x, Lanes y, Lanes z, Lanes w) : x(x), y(y), z(z), w(w) {}
  Vec4Of(Vec4 same) : x(same.x), y(same.y), z(same.z), w(same.w) {}
  Lanes x, y, z, w;
};
template <> struct ColorOf<Lanes> {
  ColorOf() = default;
  ColorOf(Lanes r, Lanes g, Lanes b) : r(r), g(g), b(b) {}
  ColorOf(Color same) : r(same.r), g(same.g), b(same.b) {}
  Lanes r, g, b;
};

namespace detail {
using Vec3s = Vec3Of<Lanes>;
using Colors = ColorOf<Lanes>;
} // namespace detail

// The same formulas as for one hit (openrts_values.hpp).
inline detail::Vec3s operator+(detail::Vec3s a, detail::Vec3s b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline detail::Vec3s operator-(detail::Vec3s a, detail::Vec3s b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline detail::Vec3s operator-(detail::Vec3s a) { return {-a.x, -a.y, -a.z}; }
inline detail::Vec3s operator*(detail::Vec3s a, Lanes s) { return {a.x * s, a.y * s, a.z * s}; }
inline detail::Vec3s operator*(Lanes s, detail::Vec3s a) { return a * s; }
inline Lanes dot(detail::Vec3s a, detail::Vec3s b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline detail::Vec3s cross(detail::Vec3s a, detail::Vec3s b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 select(bool condition, Vec3 a, Vec3 b) { return condition ? a : b; }
inline detail::Vec3s select(Mask condition, detail::Vec3s a, detail::Vec3s b) {
  return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}
// Templates, so that braces without a type, as in normalize({1, 0, 0}), always mean one vector.
template <class F> F length(Vec3Of<F> a) { return squareRoot(dot(a, a)); }
template <class F> Vec3Of<F> normalize(Vec3Of<F> a) {
  const F l = length(a);
  return select(l > 0, a * (1 / l), a);
}
inline detail::Vec3s reflect(detail::Vec3s direction, detail::Vec3s normal) {
  return direction - 2 * dot(direction, normal) * normal;
}

inline detail::Colors operator+(detail::Colors a, detail::Colors b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline detail::Colors operator-(detail::Colors a, detail::Colors b) {
  return {a.r - b.r, a.g - b.g, a.b - b.b};
}
inline detail::Colors operator*(detail::Colors a, detail::Colors b) {
  return {a.r * b.r, a.g * b.g, a.b * b.b};
}
inline detail::Colors operator*(detail::Colors a, Lanes s) { return {a.r * s, a.g * s, a.b * s}; }
inline detail::Colors operator*(Lanes s, detail::Colors a) { return a * s; }
inline detail::Colors operator/(detail::Colors a, Lanes s) { return a * (1 / s); }
inline Color select(bool condition, Color a, Color b) { return condition ? a : b; }
inline detail::Colors select(Mask condition, detail::Colors a, detail::Colors b) {
  return {select(condition, a.r, b.r), select(condition, a.g, b.g), select(condition, a.b, b.b)};
}

} // namespace rts

#endif
