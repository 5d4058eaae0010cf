// spline.cpp: Cox and de Boor's recursion for values and derivatives, and the quotient rule for
// rational curves and surfaces.
#include "geometry/nurbs/spline.h"

#include <algorithm>
#include <utility>

namespace xvrml {
namespace {

using Values = std::array<double, mostNurbsOrder>;

double quotient(double a, double b) { return b > 0 ? a / b : 0; }

// The span between two different knots that holds a parameter.
struct Span {
  const std::vector<double>& knots;
  size_t index; // knots[index] < knots[index + 1]
  double t;

  // Makes the functions of a degree from those of the degree below ("The NURBS Book" 2.5).
  Values raised(const Values& below, size_t degree) const {
    Values result{};
    for (size_t k = 0; k <= degree; k++) {
      const size_t i = index - degree + k;
      if (k > 0) // below[k - 1] is N of i with one degree less
        result[k] += quotient(t - knots[i], knots[i + degree] - knots[i]) * below[k - 1];
      if (k < degree)
        result[k] +=
            quotient(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1]) * below[k];
    }
    return result;
  }
  // Makes the derivatives of functions of a degree from those of the degree below, or from their
  // derivatives (2.7).
  Values derived(const Values& below, size_t degree) const {
    Values result{};
    for (size_t k = 0; k <= degree; k++) {
      const size_t i = index - degree + k;
      if (k > 0) result[k] += quotient(double(degree), knots[i + degree] - knots[i]) * below[k - 1];
      if (k < degree)
        result[k] -= quotient(double(degree), knots[i + degree + 1] - knots[i + 1]) * below[k];
    }
    return result;
  }
};

V3d spaceOf(const V4d& p) { return {p.x, p.y, p.z}; }

} // namespace

BasisValues KnotVector::basis(double t, bool before) const {
  const auto low = knots_.begin() + order_ - 1, high = knots_.begin() + ptrdiff_t(pointCount());
  auto after = before ? std::lower_bound(low, high, t) : std::upper_bound(low, high, t);
  if (after == low) ++after;
  while (after != low + 1 && *(after - 1) == *after) --after; // t is end()
  const Span span{knots_, size_t(after - knots_.begin()) - 1, t};
  const size_t degree = size_t(order_) - 1;
  Values value{1}, below{}, belowThat{};
  for (size_t k = 1; k <= degree; k++) {
    belowThat = std::exchange(below, value);
    value = span.raised(below, k);
  }
  BasisValues result{span.index - degree, order_, value, span.derived(below, degree), {}};
  if (degree > 1) result.second = span.derived(span.derived(belowThat, degree - 1), degree);
  return result;
}

std::vector<ParameterStep> KnotVector::steps(uint64_t count) const {
  using Side = ParameterStep::Side;
  const double first = begin(), last = end(), same = 1e-9 * (last - first);
  const size_t degree = size_t(order_) - 1;
  std::vector<ParameterStep> result;
  size_t next = degree + 1; // a knot where a curve may bend is there `degree` times
  const auto addBends = [&](double until) {
    bool here = false;
    for (; next + degree <= pointCount() && knots_[next] <= until; next++) {
      const double knot = knots_[next];
      if (knot != knots_[next + degree - 1] || knot - first <= same || last - knot <= same)
        continue;
      if (!result.empty() && result.back().t == knot) continue; // there once more
      for (const Side side : {Side::before, Side::after})
        result.push_back({knot, (knot - first) / (last - first), side});
      here = until - knot <= 2 * same;
    }
    return here;
  };
  for (uint64_t i = 0; i <= count; i++) {
    const double fraction = double(i) / double(count), t = at(fraction);
    if (!addBends(t + same) || i == count) result.push_back({t, fraction});
  }
  return result;
}

// Returns the derivative of a place by the quotient rule. derivative: that of the place times its
// weight, and of the weight.
static V3d quotient(const V4d& derivative, const V3d& place, double weight) {
  return (spaceOf(derivative) - place * derivative.w) / weight;
}

RationalCurve::Point RationalCurve::at(const BasisValues& basis) const {
  V4d value(0.0), first(0.0), second(0.0);
  for (size_t k = 0; k < size_t(basis.count); k++) {
    const V4d& point = points[basis.point + k];
    value += point * basis.value[k];
    first += point * basis.first[k];
    second += point * basis.second[k];
  }
  Point result;
  result.place = spaceOf(value) / value.w;
  result.first = quotient(first, result.place, value.w);
  result.second =
      (spaceOf(second) - result.first * (2 * first.w) - result.place * second.w) / value.w;
  return result;
}

RationalSurface::Point RationalSurface::at(const BasisValues& alongU,
                                           const BasisValues& alongV) const {
  V4d value(0.0), byU(0.0), byV(0.0);
  for (size_t j = 0; j < size_t(alongV.count); j++) {
    const V4d* row = net.data() + (alongV.point + j) * u.pointCount() + alongU.point;
    V4d sum(0.0), sumByU(0.0);
    for (size_t i = 0; i < size_t(alongU.count); i++) {
      sum += row[i] * alongU.value[i];
      sumByU += row[i] * alongU.first[i];
    }
    value += sum * alongV.value[j];
    byU += sumByU * alongV.value[j];
    byV += sum * alongV.first[j];
  }
  Point result;
  result.place = spaceOf(value) / value.w;
  result.alongU = quotient(byU, result.place, value.w);
  result.alongV = quotient(byV, result.place, value.w);
  return result;
}

V3d RationalSurface::normal(const Point& point, double atU, double atV, double scale) const {
  constexpr double vanishes = 1e-5, aside = 1e-4;
  const V3d cross = point.alongU.cross(point.alongV);
  if (cross.length() > vanishes * scale) return unit(cross);
  const auto inwards = [](const KnotVector& knots, double t) {
    const double middle = (knots.begin() + knots.end()) / 2;
    return t + (t < middle ? aside : -aside) * (knots.end() - knots.begin());
  };
  const Point near = at(inwards(u, atU), inwards(v, atV));
  return unit(near.alongU.cross(near.alongV));
}

} // namespace xvrml
