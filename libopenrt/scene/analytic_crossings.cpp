// analytic_crossings.cpp: intersects analytic surfaces with lines, in double. Quadrics, and
// aspheres without a polynomial, are quadratic equations. Aspheres with a polynomial are solved by
// interval Newton iteration (R. E. Moore, Interval Analysis, 1966, ch. 7): pieces of the line on
// which the slope keeps its sign hold at most one crossing, which a bracket encloses; other pieces
// are halved. Pure functions, any thread.
#include <algorithm>
#include <cmath>

#include "scene/analytic.h"

namespace openrt {
namespace {

// Returns a b - c d with one rounding error of the result (W. Kahan; error bound by C.-P.
// Jeannerod, N. Louvet, J.-M. Muller, Mathematics of Computation 82, 2013).
double differenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

// A quantity along a line that is known to lie between two numbers.
struct Interval {
  double low, high;
  static Interval of(double a, double b) { return {std::min(a, b), std::max(a, b)}; }
};

Interval product(const Interval& a, const Interval& b) {
  const double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
}

// Finds the root of f between a and b, where it has different signs, by Newton steps that stay in
// the bracket and bisection where they do not. f(t, slope) returns the value and the derivative.
template <class F> double rootBetween(const F& f, double a, double b, double fa) {
  double t = a + (b - a) / 2;
  for (int i = 0; i < 100; i++) {
    double slope;
    const double value = f(t, slope);
    if (value == 0) return t;
    ((value > 0) == (fa > 0) ? a : b) = t;
    double next = t - value / slope;
    if (!(next > a && next < b)) next = a + (b - a) / 2;
    if (std::fabs(next - t) <= 0x1p-52 * std::fabs(t) || next == a || next == b) return next;
    t = next;
  }
  return t;
}

} // namespace

// Clips the line to the bounds, widened by `slack`. The anchor is the middle of what is left, so
// that far origins cost no digits in what follows.
bool AnalyticSurface::clip(const Vec3d& origin, const Vec3d& direction, Segment& out,
                           double& slack) const {
  out.length = length(direction);
  if (!(out.length > 0) || !std::isfinite(out.length) || !isFinite(origin)) return false;
  out.unit = direction / out.length;
  slack = 1e-10 * size_ + 1e-15 * largest(abs(origin));
  double from = -HUGE_VAL, to = HUGE_VAL;
  for (size_t k = 0; k < 3; k++) {
    const double below = low_[k] - slack - origin[k], above = high_[k] + slack - origin[k];
    if (std::fabs(out.unit[k]) < 1e-300) {
      if (below > 0 || above < 0) return false;
      continue;
    }
    const double a = below / out.unit[k], b = above / out.unit[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (!(from <= to) || !std::isfinite(from) || !std::isfinite(to)) return false;
  // Where the origin is inside the bounds it is the anchor, so that crossings near it are exact.
  out.offset = from <= 0 && to >= 0 ? 0 : from + (to - from) / 2;
  out.anchor = origin + out.unit * out.offset;
  out.from = from - out.offset;
  out.to = to - out.offset;
  return true;
}

// Returns whether a point of the equation belongs to the surface.
bool AnalyticSurface::accepts(const Vec3d& p, double slack) const {
  if (kind_ == edit::Primitive::Quadric)
    return p.x >= low_.x - slack && p.x <= high_.x + slack && p.y >= low_.y - slack &&
           p.y <= high_.y + slack && p.z >= low_.z - slack && p.z <= high_.z + slack;
  const double square = p.x * p.x + p.y * p.y, far = outer() + slack,
               near = std::max(inner() - slack, 0.0);
  if (!(square <= far * far) || (inner() > 0 && square < near * near)) return false;
  // A conic has a second sheet or an upper half, which does not belong to the asphere.
  return polynomial() || 1 - (1 + conic()) * curvature() * p.z >= -1e-10;
}

AnalyticSurface::Crossings AnalyticSurface::intersect(const Vec3d& origin,
                                                      const Vec3d& direction) const {
  Crossings out;
  Segment segment;
  double slack;
  if (!clip(origin, direction, segment, slack)) return out;
  if (polynomial())
    crossPolynomial(segment, slack, out);
  else
    crossQuadratic(segment, slack, out);
  for (int i = 0; i < out.count; i++) {
    double& t = out.t[size_t(i)];
    t = (segment.offset + t) / segment.length;
  }
  return out;
}

// Solves a t^2 + 2 b t + c = 0. The root of larger magnitude is computed without cancellation, the
// other from the product of both.
void AnalyticSurface::crossQuadratic(const Segment& s, double slack, Crossings& out) const {
  const auto& f = form_;
  const Vec3d& u = s.unit;
  Vec3d gradient;
  const double c = valueAt(s.anchor, gradient), b = dot(gradient, u) / 2;
  const double a = u.x * (f[0] * u.x + f[3] * u.y + f[5] * u.z) + u.y * (f[1] * u.y + f[4] * u.z) +
                   f[2] * u.z * u.z;
  const double square = differenceOfProducts(b, b, a, c);
  const auto add = [&](double t) {
    Vec3d p = s.anchor + u * t, slope;
    const double value = valueAt(p, slope), step = -value / dot(slope, u);
    if (std::fabs(step) <= 1e-6 * size_) {
      t += step;
      p = s.anchor + u * t;
    }
    if (std::isfinite(t) && accepts(p, slack)) out.add(t);
  };
  if (!(square > 0x1p-50 * (b * b + std::fabs(a * c)))) {
    // The line touches the surface, or crosses it at the apex of a cone.
    const double t = -b / a;
    const Vec3d p = s.anchor + u * t;
    if (a != 0 && square >= -0x1p-50 * (b * b + std::fabs(a * c))) {
      valueAt(p, gradient);
      Vec3d around;
      valueAt(p + Vec3d{size_, size_, size_}, around);
      if (length(gradient) <= 1e-7 * length(around)) {
        if (accepts(p, slack)) out.add(t);
        return;
      }
    }
    if (!(square > 0)) return;
  }
  const double q = -(b + std::copysign(std::sqrt(square), b));
  const double first = c / q, second = q / a;
  add(first);
  if (a != 0) add(second);
  std::sort(out.t.begin(), out.t.begin() + out.count);
}

// Returns the bounds of sagSlope between two squares of the radius: the conic part is monotonic,
// and so is each term of the polynomial.
double AnalyticSurface::slopeBound(double from, double to, bool upper) const {
  const auto pick = [upper](double a, double b) { return upper ? std::max(a, b) : std::min(a, b); };
  const auto conicSlope = [&](double u) {
    const double under = 1 - (1 + conic()) * curvature() * curvature() * u;
    return curvature() / (2 * std::sqrt(std::max(under, 1e-12)));
  };
  double sum = pick(conicSlope(from), conicSlope(to)), a = from, b = to;
  for (size_t i = 0; i < terms(); i++, a *= from, b *= to) {
    const double factor = double(i + 2) * numbers_[4 + i];
    sum += pick(factor * a, factor * b);
  }
  return sum;
}

void AnalyticSurface::crossPolynomial(const Segment& s, double slack, Crossings& out) const {
  // The square of the distance from the axis is ww t^2 + 2 wo t + oo.
  const double ww = s.unit.x * s.unit.x + s.unit.y * s.unit.y,
               wo = s.unit.x * s.anchor.x + s.unit.y * s.anchor.y,
               oo = s.anchor.x * s.anchor.x + s.anchor.y * s.anchor.y;
  const auto squareAt = [&](double t) {
    const double x = s.anchor.x + t * s.unit.x, y = s.anchor.y + t * s.unit.y;
    return x * x + y * y;
  };
  double from = s.from, to = s.to;
  const double far = outer() + slack;
  if (ww > 0) { // clip to the cylinder about the aperture
    const double square = differenceOfProducts(wo, wo, ww, oo - far * far);
    if (!(square >= 0)) return;
    const double middle = -wo / ww, half = std::sqrt(square) / ww;
    from = std::max(from, middle - half);
    to = std::min(to, middle + half);
    if (!(from <= to)) return;
  } else if (oo > far * far) {
    return;
  }
  const auto f = [&](double t, double& slope) {
    const double u = squareAt(t);
    slope = s.unit.z - sagSlope(u) * 2 * (wo + t * ww);
    return s.anchor.z + t * s.unit.z - sagOf(u);
  };
  struct Piece {
    double a, b, fa, fb;
  };
  constexpr int mostOpen = 64, mostPieces = 1024;
  const double narrow = 0x1p-46 * (to - from);
  std::array<Piece, mostOpen> open;
  double slope;
  const double first = f(from, slope), last = f(to, slope);
  open[0] = {from, to, first, last};
  int waiting = 1;
  for (int count = 0; waiting > 0; count++) {
    const Piece p = open[size_t(--waiting)];
    const double middle = p.a + (p.b - p.a) / 2;
    const double nearest = ww > 0 ? std::clamp(-wo / ww, p.a, p.b) : p.a;
    const double ua = squareAt(p.a), ub = squareAt(p.b), least = squareAt(nearest),
                 most = std::max(ua, ub);
    const Interval steps = product({slopeBound(least, most, false), slopeBound(least, most, true)},
                                   Interval::of(2 * (wo + p.a * ww), 2 * (wo + p.b * ww)));
    const Interval slopes{s.unit.z - steps.high, s.unit.z - steps.low};
    const bool monotonic = slopes.low > 0 || slopes.high < 0;
    const bool changes = (p.fa > 0) != (p.fb > 0);
    if (monotonic && !changes) continue;
    double fm = 0;
    if (!monotonic) {
      fm = f(middle, slope);
      const double reach = std::max(-slopes.low, slopes.high) * (p.b - p.a) / 2;
      if (std::fabs(fm) > reach) continue;
      if (p.b - p.a > narrow && waiting + 2 <= mostOpen && count < mostPieces) {
        open[size_t(waiting++)] = {middle, p.b, fm, p.fb};
        open[size_t(waiting++)] = {p.a, middle, p.fa, fm};
        continue;
      }
      if (!changes) continue; // the line touches the surface
    }
    const double t = rootBetween(f, p.a, p.b, p.fa);
    if (accepts(s.anchor + s.unit * t, slack)) out.add(t);
  }
}

} // namespace openrt
