// scatter.h: geometry of scattering: reflection, refraction, Fresnel's equations, cosine-weighted
// directions. Pure functions.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/frame.h"

namespace openrt {

inline float dot3(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline float largest(const float v[3]) { return std::max({v[0], v[1], v[2]}); }

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

// Return sine and cosine of an angle between -pi/4 and pi/4 by their power series, exact to a unit
// in the last place.
inline float sineSmall(float x) {
  const float s = x * x;
  return x * (1 + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s * (1.0f / 362880)))));
}
inline float cosineSmall(float x) {
  const float s = x * x;
  return 1 + s * (-0.5f +
                  s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320 + s * (-1.0f / 3628800)))));
}

// Samples a direction about n with pdf cosine / pi: the concentric disc mapping of P. Shirley, K.
// Chiu (1997), lifted to the hemisphere.
inline void sampleCosineHemisphere(const float n[3], float u, float v, float out[3]) {
  const float a = 2 * u - 1, b = 2 * v - 1;
  const bool wide = std::fabs(a) > std::fabs(b); // within an eighth of a turn of the x axis
  const float r = wide ? a : b, other = wide ? b : a,
              angle = float(M_PI / 4) * (r != 0 ? other / r : 0.0f);
  const float along = r * cosineSmall(angle), across = r * sineSmall(angle);
  const float x = wide ? along : across, y = wide ? across : along,
              z = std::sqrt(std::max(0.0f, 1 - x * x - y * y));
  float s[3], t[3];
  basisOf(n, s, t);
  for (int k = 0; k < 3; k++) out[k] = x * s[k] + y * t[k] + z * n[k];
}

} // namespace openrt
