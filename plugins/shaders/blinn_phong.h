// blinn_phong.h: the highlight of VRML97 (ISO/IEC 14772-1 clause 4.14) as a reciprocal,
// energy-conserving lobe. Shared by Phong and VRML97. Pure functions. [render]
#pragma once

#include <cmath>

#include "openrt/openrts.hpp"

namespace blinn_phong {

// Returns the factor with which the BRDF (N.H)^n reflects all light that arrives along the normal,
// and less from any other direction. Its inverse is the integral of (N.H)^n cos over the hemisphere
// (F. Giesen, "Phong Normalization Factor Derivations", 2009).
inline float normalization(float exponent) {
  return (exponent + 2) * (exponent + 4) / (8 * rts::pi * (std::exp2(-exponent / 2) + exponent));
}
// Returns the reflectance, for light along the normal, of a highlight that is as bright at its peak
// as in VRML97, where a light's colour is the radiance of a white Lambertian surface.
inline float reflectance(float exponent) { return 1 / (rts::pi * normalization(exponent)); }

// Largest exponent: half vectors in float do not resolve sharper highlights.
inline constexpr float sharpest = 1e6f;

struct Lobe {
  float exponent;

  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float cosine = rts::dot(direction, normal);
    if (!(cosine > 0) || !(rts::dot(toEye, normal) > 0)) return {};
    const float value = normalization(power()) * peakShape(toEye, direction, normal) * cosine;
    return {value, value, value};
  }
  float density(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    if (!(rts::dot(direction, normal) > 0)) return 0;
    const rts::Vec3 sum = toEye + direction;
    const float cosine = rts::length(sum) / 2; // between either direction and the half vector
    if (!(cosine > 1e-6f)) return 0;
    return (power() + 1) / (2 * rts::pi) * peakShape(toEye, direction, normal) / (4 * cosine);
  }
  rts::Vec3 sample(rts::Vec3 toEye, rts::Vec2 square, rts::Vec3 normal) const {
    // 1 - cos^2 by expm1 and log, because for sharp highlights the cosine rounds to 1.
    const float sine2 = -std::expm1(2 / (power() + 1) * std::log(std::fmax(square.y, 1e-30f)));
    const float sine = std::sqrt(std::fmin(1.0f, std::fmax(0.0f, sine2))),
                phi = 2 * rts::pi * square.x;
    const float z = std::sqrt(std::fmax(0.0f, 1 - sine * sine));
    const rts::Vec3 h = rts::Frame(normal).toWorld({sine * std::cos(phi), sine * std::sin(phi), z});
    return rts::normalize(2 * rts::dot(toEye, h) * h - toEye);
  }

 private:
  float power() const { return std::fmin(sharpest, std::fmax(0.0f, exponent)); }
  // Returns (N.H)^n, computed from the sine, which is precise near the peak.
  float peakShape(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const rts::Vec3 h = rts::normalize(toEye + direction), across = rts::cross(normal, h);
    if (!(rts::dot(h, normal) > 0)) return 0;
    return std::exp(0.5f * power() * std::log1p(-std::fmin(0.9999999f, rts::dot(across, across))));
  }
};

} // namespace blinn_phong
