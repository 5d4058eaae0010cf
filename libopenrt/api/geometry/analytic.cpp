// analytic.cpp: Implements the API functions that add quadrics and aspheres. Runs on the
// application's thread.
#include <cmath>

#include "api/guard.h"
#include "scene/analytic.h"

using namespace openrt;

namespace {

void addSurface(Context& c, edit::Primitive kind, std::vector<double> numbers) {
  c.openDefinition().builder.analytic(kind, std::move(numbers), c.latch(kind));
}

// Adds the side of a cone, or of a cylinder if both radii are equal: the points whose distance from
// the y axis is the radius, which changes linearly from `low` to `high`.
void addRound(Context& c, double lowRadius, double highRadius, double low, double high) {
  require(std::isfinite(lowRadius) && std::isfinite(highRadius) && lowRadius >= 0 &&
              highRadius >= 0 && lowRadius + highRadius > 0,
          RT_INVALID_VALUE, "the radii must be finite, not negative, and not both 0");
  require(std::isfinite(low) && std::isfinite(high) && low < high, RT_INVALID_VALUE,
          "the lower end must be below the upper end, and both finite");
  // x^2 + z^2 = (at0 + slope y)^2
  const double slope = (highRadius - lowRadius) / (high - low), at0 = lowRadius - slope * low;
  // The box is wider than the side, so that it cuts only along the axis.
  const double r = 1.001 * std::max(lowRadius, highRadius);
  addSurface(
      c, edit::Primitive::Quadric,
      {1, -slope * slope, 1, 0, 0, 0, 0, -2 * at0 * slope, 0, -at0 * at0, -r, low, -r, r, high, r});
}

} // namespace

void rtQuadric(const double coefficients[10], const double low[3], const double high[3]) {
  guarded("rtQuadric", [&](Context& c) {
    require(coefficients && low && high, RT_INVALID_VALUE, "a pointer is NULL");
    std::vector<double> numbers(coefficients, coefficients + 10);
    numbers.insert(numbers.end(), low, low + 3);
    numbers.insert(numbers.end(), high, high + 3);
    addSurface(c, edit::Primitive::Quadric, std::move(numbers));
  });
}

void rtCylinder(double radius, double low, double high) {
  guarded("rtCylinder", [&](Context& c) { addRound(c, radius, radius, low, high); });
}

void rtCone(double lowRadius, double highRadius, double low, double high) {
  guarded("rtCone", [&](Context& c) { addRound(c, lowRadius, highRadius, low, high); });
}

void rtAsphere(double curvature, double conic, size_t termCount, const double* terms,
               double innerRadius, double semiAperture) {
  guarded("rtAsphere", [&](Context& c) {
    require(terms || termCount == 0, RT_INVALID_VALUE, "the pointer to the terms is NULL");
    require(termCount <= asphereTerms, RT_INVALID_VALUE, "an asphere has at most 8 terms");
    std::vector<double> numbers{curvature, conic, innerRadius, semiAperture};
    numbers.insert(numbers.end(), terms, terms + termCount);
    addSurface(c, edit::Primitive::Asphere, std::move(numbers));
  });
}
