// microfacet.h: rough surfaces as lobes of a plug-in's own: the GGX distribution of facets with
// Smith's shadowing, for any law of reflection at a facet; and that of metals. Shared by Metal,
// Reflector, Plastic and CarPaint. Pure functions. [render]
//
// B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; E. Heitz,
// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014
// (height-correlated shadowing, eq. 99).
#pragma once

#include <cmath>

#include "openrt/openrts.hpp"

namespace microfacet {

inline constexpr float smoothest = 1e-4f; // narrower distributions count as polished

// Fresnel reflectance of a metal of complex index n + ik, unpolarised: M. Born, E. Wolf,
// "Principles of Optics", 14.2. In double: it is a difference of large numbers.
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

// The distribution, in coordinates whose z is the normal. All are finite for every unit vector,
// also where a cosine is 0.
struct Ggx {
  float alpha;

  // Density of facets by solid angle. The sine is taken, not the cosine: it keeps its digits near
  // the normal, where narrow distributions need them.
  float facets(rts::Vec3 h) const {
    const float a2 = alpha * alpha, x = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (rts::pi * x * x);
  }
  // Length of a direction stretched by the distribution: cosine over Smith's shadowing is half of
  // cosine plus this.
  float stretched(rts::Vec3 v) const {
    return std::sqrt(v.z * v.z + alpha * alpha * (v.x * v.x + v.y * v.y));
  }
  // The facets seen from o, of which `sampled` chooses one, as density of the mirror image of o at
  // it: D G1 / (4 cos o).
  float seen(rts::Vec3 o, rts::Vec3 h) const { return facets(h) / (2 * (o.z + stretched(o))); }
  // D G2 / (4 cos o): the response times the cosine at i.
  float reflected(rts::Vec3 o, rts::Vec3 i, rts::Vec3 h) const {
    return facets(h) * i.z / (2 * (stretched(i) * o.z + stretched(o) * i.z));
  }
  // G2 / G1(o)
  float shadowing(rts::Vec3 o, rts::Vec3 i) const {
    const float so = stretched(o);
    return i.z * (o.z + so) / (stretched(i) * o.z + so * i.z);
  }
  // A facet among those seen from o: J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with
  // Spherical Caps", HPG 2023.
  rts::Vec3 sampled(rts::Vec3 o, rts::Vec2 square) const {
    const rts::Vec3 v = rts::normalize({alpha * o.x, alpha * o.y, o.z});
    const float phi = 2 * rts::pi * square.x, z = (1 - square.y) * (1 + v.z) - v.z;
    const float sine = std::sqrt(std::fmax(0.0f, 1 - z * z));
    const rts::Vec3 h{sine * std::cos(phi) + v.x, sine * std::sin(phi) + v.y, z + v.z};
    return rts::normalize({alpha * h.x, alpha * h.y, std::fmax(h.z, 1e-12f)});
  }
};

// Reflection at facets, each by the law `Facet`: a class of floats that gives the reflectance for a
// cosine of incidence.
template <class Facet> struct Rough {
  float alpha;
  Facet facet;

  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const rts::Vec3 o = upright(frame.toLocal(toEye)), i = frame.toLocal(direction);
    if (!(i.z > 0)) return {};
    const rts::Vec3 h = rts::normalize(o + i);
    return facet(std::fmin(1.0f, std::fmax(0.0f, rts::dot(o, h)))) *
           Ggx{width()}.reflected(o, i, h);
  }
  float density(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const rts::Vec3 o = upright(frame.toLocal(toEye)), i = frame.toLocal(direction);
    return i.z > 0 ? Ggx{width()}.seen(o, rts::normalize(o + i)) : 0.0f;
  }
  rts::Sample sample(rts::Vec3 toEye, rts::Vec2 square, rts::Vec3 normal) const {
    const rts::Frame frame(normal);
    const Ggx ggx{width()};
    const rts::Vec3 o = upright(frame.toLocal(toEye)), h = ggx.sampled(o, square);
    const float cosine = std::fmin(1.0f, std::fmax(0.0f, rts::dot(o, h)));
    const rts::Vec3 i = rts::normalize(2 * cosine * h - o);
    if (!(i.z > 0)) return {};
    return {frame.toWorld(i), facet(cosine) * ggx.shadowing(o, i), ggx.seen(o, h)};
  }

 private:
  float width() const { return std::fmin(1.0f, std::fmax(smoothest, alpha)); }
  // A bent normal may face away from the eye though the surface does not: as if it leaned the other
  // way.
  static rts::Vec3 upright(rts::Vec3 o) { return {o.x, o.y, std::fmax(std::fabs(o.z), 1e-7f)}; }
};

} // namespace microfacet
