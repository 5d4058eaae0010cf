// microfacet.h: microfacet reflection as a custom lobe: the GGX distribution with Smith shadowing,
// for any Fresnel term, and the Fresnel term of metals. Shared by Metal, Reflector, Plastic and
// CarPaint. Pure functions. [render]
//
// B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; E. Heitz,
// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014
// (height-correlated shadowing, eq. 99).
#pragma once

#include <cmath>

#include "openrt/openrts.hpp"

namespace microfacet {

inline constexpr float minAlpha = 1e-4f; // smaller values of alpha count as this

// Returns the unpolarised Fresnel reflectance of a metal with complex index n + ik (M. Born, E.
// Wolf, "Principles of Optics", 14.2). In double precision, because it is a difference of large
// numbers.
inline float conductor(double cosine, double n, double k) {
  const double c2 = cosine * cosine, s2 = 1 - c2, t = n * n - k * k - s2;
  const double ab = std::sqrt(t * t + 4 * n * n * k * k); // a^2 + b^2
  const double a = std::sqrt(std::fmax(0.0, (ab + t) / 2));
  const double below = ab + 2 * a * cosine + c2, under = c2 * ab + 2 * a * cosine * s2 + s2 * s2;
  if (!(below > 0) || !(under > 0)) return 1;
  const double s = (ab - 2 * a * cosine + c2) / below,
               p = s * (c2 * ab - 2 * a * cosine * s2 + s2 * s2) / under;
  return static_cast<float>((s + p) / 2);
}

struct Conductor {
  rts::Color n, k;
  rts::Color operator()(float cosine) const {
    return {conductor(cosine, n.r, k.r), conductor(cosine, n.g, k.g), conductor(cosine, n.b, k.b)};
  }
};

// The GGX distribution in local coordinates with the normal along z. Every result is finite for
// every unit vector, even if a cosine is 0.
struct Ggx {
  float alpha;

  // Returns D(h), the density of facet normals per solid angle. It uses the sine, which is more
  // precise than the cosine near the normal, where narrow distributions need it.
  float facets(rts::Vec3 h) const {
    const float a2 = alpha * alpha, x = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (rts::pi * x * x);
  }
  // Returns the length of v after scaling x and y by alpha. In Smith's model, cosine / G1 = (cosine
  // + this length) / 2.
  float stretchedLength(rts::Vec3 v) const {
    return std::sqrt(v.z * v.z + alpha * alpha * (v.x * v.x + v.y * v.y));
  }
  // Returns the pdf of the reflection of o at facet h, if h is chosen by sampleVisibleNormal():
  // D G1 / (4 cos o).
  float seen(rts::Vec3 o, rts::Vec3 h) const {
    return facets(h) / (2 * (o.z + stretchedLength(o)));
  }
  // Returns the BRDF times the cosine of i, without Fresnel: D G2 / (4 cos o).
  float brdfTimesCosine(rts::Vec3 o, rts::Vec3 i, rts::Vec3 h) const {
    return facets(h) * i.z / (2 * (stretchedLength(i) * o.z + stretchedLength(o) * i.z));
  }
  // G2 / G1(o)
  float g2OverG1(rts::Vec3 o, rts::Vec3 i) const {
    const float so = stretchedLength(o);
    return i.z * (o.z + so) / (stretchedLength(i) * o.z + so * i.z);
  }
  // Samples a facet normal visible from o (J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with
  // Spherical Caps", HPG 2023).
  rts::Vec3 sampleVisibleNormal(rts::Vec3 o, rts::Vec2 square) const {
    const rts::Vec3 v = rts::normalize({alpha * o.x, alpha * o.y, o.z});
    const float phi = 2 * rts::pi * square.x, z = (1 - square.y) * (1 + v.z) - v.z;
    const float sine = std::sqrt(std::fmax(0.0f, 1 - z * z));
    const rts::Vec3 h{sine * std::cos(phi) + v.x, sine * std::sin(phi) + v.y, z + v.z};
    return rts::normalize({alpha * h.x, alpha * h.y, std::fmax(h.z, 1e-12f)});
  }
};

// A microfacet reflection lobe. `Facet` is the Fresnel term: a class of floats that returns the
// reflectance for a cosine of incidence.
template <class Facet> struct MicrofacetLobe {
  float alpha;
  Facet facet;

  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const rts::Vec3 o = upright(frame.toLocal(toEye)), i = frame.toLocal(direction);
    if (!(i.z > 0)) return {};
    const rts::Vec3 h = rts::normalize(o + i);
    return facet(std::fmin(1.0f, std::fmax(0.0f, rts::dot(o, h)))) *
           Ggx{width()}.brdfTimesCosine(o, i, h);
  }
  float density(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const rts::Vec3 o = upright(frame.toLocal(toEye)), i = frame.toLocal(direction);
    return i.z > 0 ? Ggx{width()}.seen(o, rts::normalize(o + i)) : 0.0f;
  }
  rts::Sample sample(rts::Vec3 toEye, rts::Vec2 square, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const Ggx ggx{width()};
    const rts::Vec3 o = upright(frame.toLocal(toEye)), h = ggx.sampleVisibleNormal(o, square);
    const float cosine = std::fmin(1.0f, std::fmax(0.0f, rts::dot(o, h)));
    const rts::Vec3 i = rts::normalize(2 * cosine * h - o);
    if (!(i.z > 0)) return {};
    return {frame.toWorld(i), facet(cosine) * ggx.g2OverG1(o, i), ggx.seen(o, h)};
  }

 private:
  float width() const { return std::fmin(1.0f, std::fmax(minAlpha, alpha)); }
  // A shading normal may face away from the eye although the surface does not. It is then mirrored
  // to the eye's side.
  static rts::Vec3 upright(rts::Vec3 o) { return {o.x, o.y, std::fmax(std::fabs(o.z), 1e-7f)}; }
};

} // namespace microfacet
