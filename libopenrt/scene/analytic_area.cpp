// analytic_area.cpp: samples analytic surfaces by area, for those that emit light: surfaces of
// revolution, whose elements of area are known (Pappus). Pure functions, any thread.
#include <cmath>

#include "scene/analytic.h"

namespace openrt {
namespace {

constexpr double slack = 1e-9; // relative: numbers that differ by rounding alone

bool same(double a, double b) { return std::fabs(a - b) <= slack * (std::fabs(a) + std::fabs(b)); }

} // namespace

int AnalyticSurface::axisOfRevolution() const {
  if (kind_ == edit::Primitive::Asphere) return 2;
  const auto& f = form_;
  if (f[3] != 0 || f[4] != 0 || f[5] != 0) return -1;
  for (const size_t k : {1, 2, 0}) { // y as VRML's Cylinder and Cone
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    if (f[i] != 0 && same(f[i], f[j]) && f[6 + i] == 0 && f[6 + j] == 0) return int(k);
  }
  return -1;
}

// This holds for a quadric of revolution: f_i r^2 + f_k t^2 + f_6k t + f_9 = 0 at t along the axis.
double AnalyticSurface::squaredRadius(double t, double& slope) const {
  const auto k = size_t(axis_), i = (k + 1) % 3;
  slope = -(2 * form_[k] * t + form_[6 + k]) / form_[i];
  return -((form_[k] * t + form_[6 + k]) * t + form_[9]) / form_[i];
}

Vec3d AnalyticSurface::pointAt(double u, double v) const {
  const auto k = size_t(axis_), i = (k + 1) % 3, j = (k + 2) % 3;
  double square, along;
  if (kind_ == edit::Primitive::Asphere) {
    const double from = inner() * inner();
    square = from + u * (outer() * outer() - from);
    along = sagOf(square);
  } else {
    double slope;
    along = low_[k] + u * (high_[k] - low_[k]);
    square = squaredRadius(along, slope);
  }
  const double radius = std::sqrt(std::max(square, 0.0));
  Vec3d p;
  p[k] = along;
  p[i] = radius * std::cos(2 * M_PI * v);
  p[j] = radius * std::sin(2 * M_PI * v);
  return p;
}

// A ring of a quadric of length dt along the axis has the area 2 pi sqrt(r^2 + (r dr/dt)^2) dt, one
// of an asphere pi sqrt(1 + (dz/dr)^2) d(r^2).
double AnalyticSurface::areaAt(const Vec3d& p) const {
  const auto k = size_t(axis_), i = (k + 1) % 3, j = (k + 2) % 3;
  if (kind_ == edit::Primitive::Asphere) {
    const double square = p.x * p.x + p.y * p.y, slope = sagSlope(square);
    return M_PI * (outer() * outer() - inner() * inner()) *
           std::sqrt(1 + 4 * square * slope * slope);
  }
  for (const size_t across : {i, j})
    if (p[across] < low_[across] - slack * size_ || p[across] > high_[across] + slack * size_)
      return 0;
  double slope;
  const double square = squaredRadius(p[k], slope);
  return square < 0 ? 0 : 2 * M_PI * (high_[k] - low_[k]) * std::sqrt(square + slope * slope / 4);
}

} // namespace openrt
