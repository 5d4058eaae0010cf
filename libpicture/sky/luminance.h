// luminance.h: The relative luminance of a sky by direction, in the form that the standard skies of
// ISO 15469:2004 (CIE S 011/E:2003) and the all-weather model of R. Perez share: a gradation from
// the zenith to the horizon, times an indicatrix around the sun. Pure functions. [any thread]
#pragma once

#include <array>

namespace picture {

using Direction = std::array<double, 3>; // a unit vector: east, up, south

struct SkyLuminance {
  // gradation 1 + a exp(b / cos Z), Z: angle from the zenith; indicatrix
  // 1 + c (exp(d x) - offset) + e cos^2 x, x: angle from the sun
  double a = 0, b = -1, c = 0, d = -1, e = 0;
  double offset = 0;
  // The sky of P. Moon and D. Spencer, "Illumination from a non-uniform sky", 1942, that CIE
  // calls type 16: (1 + 2 cos Z) / 3; the coefficients are ignored.
  bool isTraditional = false;

  // Returns the luminance over that of some direction, at least 0. up: cosine of the angle from the
  // zenith, above 0; fromSun: angle from the sun in radians.
  double at(double up, double fromSun) const;
  bool operator==(const SkyLuminance&) const = default;
};

constexpr int traditionalSky = 16;
// Returns a standard sky. type: 1 to 15, or traditionalSky.
SkyLuminance standardSky(int type);

// Returns the illuminance of a horizontal plane by such a sky, in the unit of its luminance. sun:
// where it stands; the sky ends at the horizon.
double horizontalIlluminance(const SkyLuminance& sky, const Direction& sun);

// Returns the angle between two directions, in radians.
double angleBetween(const Direction& a, const Direction& b);

} // namespace picture
