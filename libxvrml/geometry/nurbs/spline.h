// spline.h: rational B-splines: basis functions by their knots, curves and surfaces with
// derivatives (L. Piegl, W. Tiller, "The NURBS Book", 2nd edition, chapters 2 to 4). Pure
// functions; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/vector_math.h"

namespace xvrml {

using V4d = Imath::V4d;

// Polynomials of a higher degree lose their digits.
inline constexpr int mostNurbsOrder = 32;

// The basis functions that are not zero at a parameter, with two derivatives.
struct BasisValues {
  size_t point = 0; // the control point of the first function
  int count = 0;
  std::array<double, mostNurbsOrder> value, first, second;
};

// A place of the range of a parameter. Where a curve may bend at a knot there are two, one for the
// derivatives of each side.
struct ParameterStep {
  enum class Side : uint8_t { inside, before, after };
  double t, fraction;
  Side side = Side::inside;
};

// The knots of one parameter. There are more than 2 * order - 1 of them, they do not decrease, and
// begin() is less than end().
class KnotVector {
 public:
  KnotVector(int order, std::vector<double>&& knots) : order_(order), knots_(std::move(knots)) {}

  int order() const { return order_; }
  size_t pointCount() const { return knots_.size() - size_t(order_); }
  double begin() const { return knots_[size_t(order_) - 1]; }
  double end() const { return knots_[pointCount()]; }
  // Returns the parameter at a fraction of the way from begin() to end().
  double at(double fraction) const {
    return fraction < 1 ? begin() + (end() - begin()) * fraction : end();
  }
  // t: begin() to end(). At a knot the derivatives are those of the span after it, or before it.
  BasisValues basis(double t, bool before = false) const;
  BasisValues basis(const ParameterStep& step) const {
    return basis(step.t, step.side == ParameterStep::Side::before);
  }
  // Returns the ends of equal steps from begin() to end(), with the knots where a curve may bend.
  std::vector<ParameterStep> steps(uint64_t count) const;

 private:
  int order_;
  std::vector<double> knots_;
};

// Control points are homogeneous: (w x, w y, w z, w).
struct RationalCurve {
  KnotVector knots;
  std::vector<V4d> points;

  struct Point {
    V3d place, first, second; // with the derivatives by the parameter
  };
  Point at(const BasisValues& basis) const;
  Point at(double t) const { return at(knots.basis(t)); }
};

struct RationalSurface {
  KnotVector u, v;
  std::vector<V4d> net; // row by row along u

  struct Point {
    V3d place, alongU, alongV; // with the derivatives by the parameters
  };
  Point at(const BasisValues& alongU, const BasisValues& alongV) const;
  Point at(double atU, double atV) const { return at(u.basis(atU), v.basis(atV)); }
  // Returns the unit normal alongU x alongV. Where this vanishes, as at a pole, it is the normal
  // nearby, towards the middle of the surface; zero if that vanishes, too.
  // scale: the length of alongU x alongV where the surface is regular.
  V3d normal(const Point& point, double atU, double atV, double scale) const;
};

} // namespace xvrml
