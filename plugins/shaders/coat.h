// coat.h: a matt body under a smooth clear coat. Shared by Plastic, CarPaint, Wood, Marble and
// Checker. Pure functions. [render]
//
// What enters is scattered evenly and partly thrown back again from below the boundary; all of
// these reflections are summed: f = T(in) T(out) albedo / (pi n^2 (1 - albedo Fi)), T = 1 - F, Fi
// the mean reflectance from within. With 1 - Fi = (1 - Fo) / n^2, Fo that from outside, a white
// body reflects exactly what the coat lets through: energy is kept.
#pragma once

#include <cmath>

#include "openrt/openrts.hpp"

namespace coat {

// Mean of Fresnel's reflectance over the hemisphere of a medium of index n > 1, seen from outside:
// R. Dunkle, "Thermal Radiation Characteristics of Surfaces", 1963, after J. Walsh (1926).
inline double meanReflectance(double n) {
  if (!(n > 1.001)) return 0;
  const double n2 = n * n, n4 = n2 * n2, a = n2 + 1, b = n4 - 1;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * (n2 - 1) * (n2 - 1) / (a * a * a) * std::log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / (a * b) + 8 * n4 * (n4 + 1) / (a * b * b) * std::log(n);
}

inline float through(float cosine, float index) {
  return index > 1.001f ? static_cast<float>(1 - rts::fresnel(cosine, 1 / double(index))) : 1.0f;
}

// Directions by Lambert's cosine: what all lobes of matt bodies share.
inline float cosineDensity(rts::Vec3 direction, rts::Vec3 normal) {
  return std::fmax(0.0f, rts::dot(direction, normal)) / rts::pi;
}
inline rts::Vec3 cosineDirection(rts::Vec2 square, rts::Vec3 normal) {
  const float r = std::sqrt(square.x), phi = 2 * rts::pi * square.y;
  return rts::Frame(normal).toWorld(
      {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::fmax(0.0f, 1 - square.x))});
}

// Weight: `colour` of the albedo.
struct Matt {
  float index, scale;

  static Matt of(float index) {
    return {index, static_cast<float>(1 / (1 - meanReflectance(index)))};
  }
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float in = rts::dot(direction, normal), out = std::fmax(0.0f, rts::dot(toEye, normal));
    if (!(in > 0)) return {};
    const float value = scale * through(std::fmin(1.0f, in), index) *
                        through(std::fmin(1.0f, out), index) * in / rts::pi;
    return {value, value, value};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3 normal) const {
    return cosineDensity(direction, normal);
  }
  rts::Vec3 sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const {
    return cosineDirection(square, normal);
  }
};

// What is left of light that is thrown back and forth below the coat, against a white body's.
inline float colour(float albedo, double inner) {
  const double a = std::fmin(1.0, std::fmax(0.0, double(albedo)));
  return static_cast<float>(a * (1 - inner) / (1 - a * inner));
}
inline rts::Color colour(rts::Color albedo, float index) {
  const double n = index > 1.001f ? index : 1.0, inner = 1 - (1 - meanReflectance(n)) / (n * n);
  return {colour(albedo.r, inner), colour(albedo.g, inner), colour(albedo.b, inner)};
}

// A matt body of an albedo under a smooth coat of an index of refraction; up to 1: no coat.
inline void add(const rts::Hit& hit, rts::Closures& out, rts::Color albedo, float index) {
  out.albedo(albedo);
  if (!(index > 1.001f)) return out.diffuse(albedo);
  const float f = 1 - through(hit.cosine(), index);
  out.reflection({f, f, f});
  out.custom(colour(albedo, index), Matt::of(index));
}

} // namespace coat
