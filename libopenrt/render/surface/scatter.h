// scatter.h: geometry of scattering: reflection, refraction, Fresnel's equations. Pure functions.
// render/lanes/directions-inl.h has them for vector lanes, with the same operations and so the same
// numbers.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/vec3.h"

namespace openrt {

// Reflects a direction that points towards the surface, at a normal.
inline Vec3f reflectAt(const Vec3f& d, const Vec3f& n) { return d - 2 * dot(d, n) * n; }

// Returns the Fresnel reflectance of unpolarised light at a smooth dielectric boundary. cosine:
// cosine of the angle of incidence, 0..1. eta: index on the ray's side over that on the far side.
// cosineBehind gets the cosine of the refracted angle, 0 under total reflection. It is computed in
// double, because near the critical angle the root loses half of the digits. M. Born, E. Wolf,
// "Principles of Optics", 1.5.2.
inline double fresnel(double cosine, double eta, double& cosineBehind) {
  const double sineBehind2 = eta * eta * std::max(0.0, 1 - cosine * cosine);
  if (sineBehind2 >= 1) {
    cosineBehind = 0;
    return 1;
  }
  cosineBehind = std::sqrt(1 - sineBehind2);
  const double s = (eta * cosine - cosineBehind) / (eta * cosine + cosineBehind);
  const double p = (cosine - eta * cosineBehind) / (cosine + eta * cosineBehind);
  return (s * s + p * p) / 2;
}

// Refracts a direction by Snell's law in vector form. d points towards the surface, n against d.
inline Vec3f refractAt(const Vec3f& d, const Vec3f& n, double eta, double cosine,
                       double cosineBehind) {
  const Vec3d r = eta * Vec3d(d) + (eta * cosine - cosineBehind) * Vec3d(n);
  // The direction is normalised again, so that errors do not grow over a long chain of refractions.
  const double square = dot(r, r);
  return Vec3f(r * (square > 0 ? 1 / std::sqrt(square) : 0));
}

} // namespace openrt
