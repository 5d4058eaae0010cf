// scatter.h: geometry of scattering: reflection, refraction, Fresnel's equations. Pure functions.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/frame.h"
#include "render/vectors.h"

namespace openrt {

// Reflects a direction that points towards the surface, at a normal.
inline void reflectAt(const float d[3], const float n[3], float out[3]) {
  const float twice = 2 * dot3(d, n);
  for (int k = 0; k < 3; k++) out[k] = d[k] - twice * n[k];
}

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
inline void refractAt(const float d[3], const float n[3], double eta, double cosine,
                      double cosineBehind, float out[3]) {
  double length = 0, r[3];
  for (int k = 0; k < 3; k++) {
    r[k] = eta * d[k] + (eta * cosine - cosineBehind) * n[k];
    length += r[k] * r[k];
  }
  // The direction is normalised again, so that errors do not grow over a long chain of refractions.
  const double s = length > 0 ? 1 / std::sqrt(length) : 0;
  for (int k = 0; k < 3; k++) out[k] = float(r[k] * s);
}

} // namespace openrt
