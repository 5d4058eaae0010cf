// analytic.cpp: the equations of analytic surfaces: checks, bounds, values, tangents.
// analytic_crossings.cpp intersects them with lines, analytic_area.cpp samples them. Pure
// functions, any thread.
#include "scene/analytic.h"

#include <cmath>
#include <cstdio>

namespace openrt {
namespace {

constexpr double smallestLength = 1e-12, largestLength = 1e12;
constexpr double deepest = 1e6; // largest sag, in radii of the aperture

std::string numbered(const char* format, double a, double b = 0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

bool allFinite(std::span<const double> numbers) {
  for (const double x : numbers)
    if (!std::isfinite(x)) return false;
  return true;
}

// Returns the sum of the magnitudes of a quadric's terms at the point of a box where it is largest.
double magnitudeOf(std::span<const double> q, const Vec3d& reach) {
  const auto& [x, y, z] = reach;
  const double monomials[10] = {x * x, y * y, z * z, x * y, y * z, z * x, x, y, z, 1};
  double sum = 0;
  for (size_t i = 0; i < 10; i++) sum += std::fabs(q[i]) * monomials[i];
  return sum;
}

std::string problemOfQuadric(std::span<const double> n) {
  if (n.size() != 16) return "a quadric has ten coefficients and a box";
  if (!allFinite(n.first(10))) return "a coefficient of the quadric is not finite";
  if (!allFinite(n.subspan(10))) return "the box of the quadric is not finite";
  const Vec3d low = vectorOf(&n[10]), high = vectorOf(&n[13]);
  if (!(low.x < high.x && low.y < high.y && low.z < high.z))
    return "the lower corner of the quadric's box must be below the upper one on every axis";
  if (largest(max(abs(low), abs(high))) > largestLength)
    return "the box of the quadric reaches beyond 1e12";
  if (smallest(high - low) < smallestLength) return "the box of the quadric is thinner than 1e-12";
  double most = 0;
  for (size_t i = 0; i < 9; i++) most = std::max(most, std::fabs(n[i]));
  if (most == 0) return "the quadric has no coefficient besides the constant, so it is no surface";
  const double magnitude = magnitudeOf(n, max(abs(low), abs(high)));
  if (!(magnitude <= 1e100)) return "the coefficients of the quadric overflow within its box";
  if (magnitude < 1e-100) return "the coefficients of the quadric vanish within its box";
  return {};
}

std::string problemOfAsphere(std::span<const double> n) {
  if (n.size() < 4 || n.size() > 4 + asphereTerms)
    return "an asphere has a curvature, a conic constant, two radii and at most 8 further terms";
  if (!allFinite(n)) return "a number of the asphere is not finite";
  const double c = n[0], k = n[1], inner = n[2], outer = n[3];
  if (!(outer >= smallestLength && outer <= largestLength))
    return numbered("the semi-aperture %.9g of the asphere is not from 1e-12 to 1e12", outer);
  if (!(inner >= 0 && inner < outer))
    return numbered("the inner radius %.9g of the asphere is not from 0 to below the semi-aperture "
                    "%.9g",
                    inner, outer);
  double sag = std::fabs(c) * outer * outer, power = outer * outer * outer * outer;
  for (size_t i = 4; i < n.size(); i++, power *= outer * outer) sag += std::fabs(n[i]) * power;
  if (!(sag <= deepest * outer))
    return numbered("the asphere is more than a million times deeper than its semi-aperture %.9g: "
                    "check the units of curvature and coefficients",
                    outer);
  // z exists up to the radius at which the square root is 0.
  const double root = (1 + k) * c * c * outer * outer;
  const bool polynomial = n.size() > 4;
  if (!(root <= (polynomial ? 1 - 1e-6 : 1 + 1e-12))) {
    const double edge = 1 / (std::fabs(c) * std::sqrt(1 + k));
    return numbered(polynomial ? "the semi-aperture %.9g of the asphere must be below %.9g, the "
                                 "radius at which its conic part is vertical"
                               : "the semi-aperture %.9g of the asphere is beyond its edge, which "
                                 "is at %.9g",
                    outer, edge);
  }
  if (root < -1e100)
    return numbered("the conic constant %.9g of the asphere overflows within its semi-aperture "
                    "%.9g",
                    k, outer);
  return {};
}

} // namespace

std::string AnalyticSurface::problemOf(edit::Primitive kind, std::span<const double> numbers) {
  if (kind == edit::Primitive::Quadric) return problemOfQuadric(numbers);
  if (kind == edit::Primitive::Asphere) return problemOfAsphere(numbers);
  return numbers.empty() ? ""
                         : "a geometry of triangles, lines, points or a sphere has numbers of "
                           "an analytic surface";
}

std::shared_ptr<const AnalyticSurface> AnalyticSurface::make(edit::Primitive kind,
                                                             std::span<const double> numbers) {
  if (!isAnalytic(kind) || !problemOf(kind, numbers).empty()) return nullptr;
  return std::make_shared<const AnalyticSurface>(kind, numbers);
}

AnalyticSurface::AnalyticSurface(edit::Primitive kind, std::span<const double> numbers)
    : kind_(kind), count_(numbers.size()) {
  std::copy(numbers.begin(), numbers.end(), numbers_.begin());
  if (kind_ == edit::Primitive::Asphere) {
    while (count_ > 4 && numbers_[count_ - 1] == 0) count_--;
    const double c = curvature();
    form_ = {-c, -c, -c * (1 + conic()), 0, 0, 0, 0, 0, 2, 0};
  } else {
    std::copy_n(numbers_.begin(), 10, form_.begin());
  }
  setBounds();
  axis_ = axisOfRevolution();
}

void AnalyticSurface::setBounds() {
  if (kind_ == edit::Primitive::Quadric) {
    low_ = vectorOf(&numbers_[10]);
    high_ = vectorOf(&numbers_[13]);
  } else {
    // The conic part and each term rise or fall from the inner to the outer radius.
    const double a = inner() * inner(), b = outer() * outer();
    const auto conicSag = [&](double u) {
      const double under = 1 - (1 + conic()) * curvature() * curvature() * u;
      return curvature() * u / (1 + std::sqrt(std::max(under, 0.0)));
    };
    double bottom = std::min(conicSag(a), conicSag(b)), top = std::max(conicSag(a), conicSag(b));
    double from = a * a, to = b * b;
    for (size_t i = 0; i < terms(); i++, from *= a, to *= b) {
      const double x = numbers_[4 + i] * from, y = numbers_[4 + i] * to;
      bottom += std::min(x, y);
      top += std::max(x, y);
    }
    low_ = {-outer(), -outer(), bottom};
    high_ = {outer(), outer(), top};
  }
  size_ = largest(high_ - low_);
}

double AnalyticSurface::sagOf(double u) const {
  const double under = 1 - (1 + conic()) * curvature() * curvature() * u;
  double sum = 0;
  for (size_t i = terms(); i-- > 0;) sum = sum * u + numbers_[4 + i];
  return curvature() * u / (1 + std::sqrt(std::max(under, 0.0))) + sum * u * u;
}

double AnalyticSurface::sagSlope(double u) const {
  const double under = 1 - (1 + conic()) * curvature() * curvature() * u;
  double sum = 0;
  for (size_t i = terms(); i-- > 0;) sum = sum * u + double(i + 2) * numbers_[4 + i];
  return curvature() / (2 * std::sqrt(std::max(under, 1e-12))) + sum * u;
}

double AnalyticSurface::valueAt(const Vec3d& p, Vec3d& gradient) const {
  if (polynomial()) {
    const double u = p.x * p.x + p.y * p.y, slope = 2 * sagSlope(u);
    gradient = {-slope * p.x, -slope * p.y, 1};
    return p.z - sagOf(u);
  }
  const auto& f = form_;
  gradient = {2 * f[0] * p.x + f[3] * p.y + f[5] * p.z + f[6],
              2 * f[1] * p.y + f[3] * p.x + f[4] * p.z + f[7],
              2 * f[2] * p.z + f[4] * p.y + f[5] * p.x + f[8]};
  return p.x * (f[0] * p.x + f[3] * p.y + f[5] * p.z + f[6]) +
         p.y * (f[1] * p.y + f[4] * p.z + f[7]) + p.z * (f[2] * p.z + f[8]) + f[9];
}

Vec3d AnalyticSurface::settle(const Vec3d& point, const Vec3d& direction) const {
  const Vec3d unit = normalize(direction);
  Vec3d p = point, gradient;
  double value = valueAt(p, gradient);
  // A step is taken only if it comes closer to the surface, so this ends.
  const auto step = [&](const Vec3d& by) {
    Vec3d there;
    const Vec3d next = p + by;
    const double then = valueAt(next, there);
    if (!(std::fabs(then) < std::fabs(value)) || !isFinite(next)) return false;
    p = next;
    value = then;
    gradient = there;
    return true;
  };
  for (int i = 0; i < 4; i++) {
    const double along = dot(gradient, unit);
    // At grazing angles the step along the ray is long and ill-defined.
    if (!(along * along > 1e-6 * dot(gradient, gradient))) break;
    if (!step(unit * (-value / along))) break;
  }
  for (int i = 0; i < 4; i++) {
    const double square = dot(gradient, gradient);
    if (!(square > 0) || !step(gradient * (-value / square))) break;
  }
  return p;
}

std::array<double, 2> AnalyticSurface::texCoordAt(const Vec3d& p) const {
  if (kind_ == edit::Primitive::Asphere)
    return {0.5 + p.x / (2 * outer()), 0.5 + p.y / (2 * outer())};
  const double turn = std::atan2(-p.x, -p.z) * (0.5 / M_PI);
  return {turn < 0 ? turn + 1 : turn, (p.y - low_.y) / (high_.y - low_.y)};
}

// The tangents v solve ds . v = 1, dt . v = 0, normal . v = 0 and the same with s and t exchanged,
// where ds and dt are the gradients of the texture coordinates.
AnalyticSurface::Tangents AnalyticSurface::tangentsAt(const Vec3d& p) const {
  Vec3d ds, dt, normal;
  valueAt(p, normal);
  if (kind_ == edit::Primitive::Asphere) {
    ds = {1 / (2 * outer()), 0, 0};
    dt = {0, 1 / (2 * outer()), 0};
  } else {
    const double round = p.x * p.x + p.z * p.z;
    if (round > 0) ds = Vec3d{p.z, 0, -p.x} / (2 * M_PI * round);
    dt = {0, 1 / (high_.y - low_.y), 0};
  }
  const double volume = dot(ds, cross(dt, normal));
  if (volume == 0 || !std::isfinite(volume)) return {};
  return {cross(dt, normal) / volume, cross(normal, ds) / volume};
}

} // namespace openrt
