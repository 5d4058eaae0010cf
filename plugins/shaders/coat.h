// coat.h: a diffuse base under a smooth clear coat. Shared by Plastic, CarPaint, Wood, Marble and
// Checker. Pure functions. [render]
//
// Light that enters is scattered diffusely and partly reflected back from below the boundary. All
// inter-reflections are summed:
//   f = T(in) T(out) albedo / (pi n^2 (1 - albedo Fi))
// T = 1 - F is the transmittance of the boundary, Fi its mean reflectance from inside, Fo from
// outside. Since 1 - Fi = (1 - Fo) / n^2, a white base reflects exactly the light that the coat
// transmits, so energy is conserved.
#pragma once

#include <cmath>

#include "openrt/openrts.hpp"

namespace coat {

// Returns the cosine-weighted mean of the Fresnel reflectance over the hemisphere, from outside a
// medium of index n > 1 (R. Dunkle, "Thermal Radiation Characteristics of Surfaces", 1963, after J.
// Walsh, 1926).
inline double meanReflectance(double n) {
  if (!(n > 1.001)) return 0;
  const double n2 = n * n, n4 = n2 * n2, a = n2 + 1, b = n4 - 1;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * (n2 - 1) * (n2 - 1) / (a * a * a) * std::log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / (a * b) + 8 * n4 * (n4 + 1) / (a * b * b) * std::log(n);
}

inline float transmittance(float cosine, float index) {
  return index > 1.001f ? static_cast<float>(1 - rts::fresnel(cosine, 1 / double(index))) : 1.0f;
}

// Cosine-weighted sampling, shared by the lobes of diffuse bases.
inline float cosinePdf(rts::Vec3 direction, rts::Vec3 normal) {
  return std::fmax(0.0f, rts::dot(direction, normal)) / rts::pi;
}
inline rts::Vec3 sampleCosine(rts::Vec2 square, rts::Vec3 normal) {
  const float r = std::sqrt(square.x), phi = 2 * rts::pi * square.y;
  return rts::Frame(normal).toWorld(
      {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::fmax(0.0f, 1 - square.x))});
}

// The lobe of a diffuse base under a smooth coat. Its weight is colour(albedo, index).
struct CoatedDiffuse {
  float index, scale;

  static CoatedDiffuse of(float index) {
    return {index, static_cast<float>(1 / (1 - meanReflectance(index)))};
  }
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float in = rts::dot(direction, normal), out = std::fmax(0.0f, rts::dot(toEye, normal));
    if (!(in > 0)) return {};
    const float value = scale * transmittance(std::fmin(1.0f, in), index) *
                        transmittance(std::fmin(1.0f, out), index) * in / rts::pi;
    return {value, value, value};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3 normal) const {
    return cosinePdf(direction, normal);
  }
  rts::Vec3 sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const {
    return sampleCosine(square, normal);
  }
};

// Returns the reflectance of the base including inter-reflections below the coat, relative to that
// of a white base. inner: mean reflectance of the boundary from inside.
inline float colour(float albedo, double inner) {
  const double a = std::fmin(1.0, std::fmax(0.0, double(albedo)));
  return static_cast<float>(a * (1 - inner) / (1 - a * inner));
}
template <class F> rts::ColorOf<F> colour(rts::ColorOf<F> albedo, float index) {
  const double n = index > 1.001f ? index : 1.0, inner = 1 - (1 - meanReflectance(n)) / (n * n);
  const auto channel = [inner](float a) { return colour(a, inner); };
  return {rts::eachLane(channel, albedo.r), rts::eachLane(channel, albedo.g),
          rts::eachLane(channel, albedo.b)};
}

// Adds a diffuse base under a smooth coat with this index of refraction; up to 1: no coat. `shown`
// is the share of the surface, by colour, that is there.
template <class F> void add(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out,
                            rts::ColorOf<F> albedo, float index,
                            rts::ColorOf<F> shown = {1, 1, 1}) {
  out.albedo(albedo);
  if (!(index > 1.001f)) return out.diffuse(shown * albedo);
  const F f = 1 - rts::eachLane([index](float c) { return transmittance(c, index); }, hit.cosine());
  out.coat();
  out.reflection(shown * rts::ColorOf<F>{f, f, f});
  out.coat(false);
  out.custom(shown * colour(albedo, index), CoatedDiffuse::of(index));
}

} // namespace coat
