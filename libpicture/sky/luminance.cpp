#include "libpicture/sky/luminance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace picture {

namespace {

struct Row {
  double a, b, c, d, e;
};
// ISO 15469:2004, table 1: types 1 to 15
constexpr Row rows[] = {
    {4, -.7, 0, -1, 0},       {4, -.7, 2, -1.5, .15},  {1.1, -.8, 0, -1, 0},
    {1.1, -.8, 2, -1.5, .15}, {0, -1, 0, -1, 0},       {0, -1, 2, -1.5, .15},
    {0, -1, 5, -2.5, .3},     {0, -1, 10, -3, .45},    {-1, -.55, 2, -1.5, .15},
    {-1, -.55, 5, -2.5, .3},  {-1, -.55, 10, -3, .45}, {-1, -.32, 10, -3, .45},
    {-1, -.32, 16, -3, .3},   {-1, -.15, 16, -3, .3},  {-1, -.15, 24, -2.8, .15},
};

} // namespace

double SkyLuminance::at(double up, double fromSun) const {
  if (isTraditional) return (1 + 2 * up) / 3;
  constexpr double mostExponent = 100; // keeps what grows towards the horizon finite
  const double exponent = std::min(b / std::max(up, 1e-6), mostExponent),
               cosine = std::cos(fromSun);
  const double gradation = 1 + a * std::exp(exponent),
               indicatrix = 1 + c * (std::exp(d * fromSun) - offset) + e * cosine * cosine;
  return std::max(gradation, 0.0) * std::max(indicatrix, 0.0);
}

SkyLuminance standardSky(int type) {
  SkyLuminance sky;
  sky.isTraditional = type == traditionalSky;
  if (sky.isTraditional) return sky;
  const Row& row = rows[type - 1];
  sky.a = row.a;
  sky.b = row.b;
  sky.c = row.c;
  sky.d = row.d;
  sky.e = row.e;
  sky.offset = std::exp(row.d * std::numbers::pi / 2);
  return sky;
}

double angleBetween(const Direction& a, const Direction& b) {
  const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// Uses the midpoint rule on cells of equal cosine squared, where each has the same weight.
double horizontalIlluminance(const SkyLuminance& sky, const Direction& sun) {
  constexpr int rings = 1024, columns = 256;
  double sum = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const double up = std::sqrt((ring + .5) / rings), side = std::sqrt(1 - up * up);
    for (int column = 0; column < columns; ++column) {
      const double turn = 2 * std::numbers::pi * (column + .5) / columns;
      const Direction d{side * std::cos(turn), up, side * std::sin(turn)};
      sum += sky.at(up, angleBetween(d, sun));
    }
  }
  return std::numbers::pi * sum / (double(rings) * columns);
}

} // namespace picture
