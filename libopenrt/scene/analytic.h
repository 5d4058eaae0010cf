// analytic.h: surfaces that are given by an equation instead of triangles: quadrics in a box, and
// aspheres, the surfaces of revolution of which lenses and reflectors are made. All functions are
// pure and compute in double, in the surface's own frame. [any thread]
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "edits_generated.h"
#include "scene/vec3.h"

namespace openrt {

// The largest number of polynomial terms of an asphere.
inline constexpr size_t asphereTerms = 8;

// The numbers of a surface, as edits carry them (edits.fbs, Geometry.surface):
//  - Quadric: the coefficients of x^2, y^2, z^2, xy, yz, zx, x, y, z and 1, then the lower and the
//    upper corner of its box. The front is where the polynomial is positive.
//  - Asphere: curvature c, conic constant k, inner and outer radius, then the coefficients a of
//    r^4, r^6 and so on. It is the surface
//      z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a_4 r^4 + a_6 r^6 + ...
//    between the two radii (ISO 10110-12, equation for surfaces of revolution). The front faces +z.
class AnalyticSurface {
 public:
  static bool isAnalytic(edit::Primitive kind) {
    return kind == edit::Primitive::Quadric || kind == edit::Primitive::Asphere;
  }
  // Returns what is wrong with the numbers of a surface, or an empty text.
  static std::string problemOf(edit::Primitive kind, std::span<const double> numbers);
  // Makes a surface. Its numbers must have no problem.
  AnalyticSurface(edit::Primitive kind, std::span<const double> numbers);
  // Makes a surface, or null if the numbers are none.
  static std::shared_ptr<const AnalyticSurface> make(edit::Primitive kind,
                                                     std::span<const double> numbers);

  edit::Primitive kind() const { return kind_; }
  std::vector<double> numbers() const { return {numbers_.begin(), numbers_.begin() + count_}; }
  bool operator==(const AnalyticSurface& other) const = default;

  const Vec3d& low() const { return low_; }
  const Vec3d& high() const { return high_; }

  // Returns the value of the surface's equation at a point. `gradient` gets its derivative, which
  // points to the front; it is 0 at the apex of a cone.
  double valueAt(const Vec3d& p, Vec3d& gradient) const;

  // Finds where the line from `origin` along `direction` crosses the surface within its box or its
  // radii, ascending. Distances are in lengths of the direction. Points where the line only touches
  // the surface do not count, except the apex of a cone. The limits of a surface are widened by
  // 1e-10 of its size and by the rounding error of far origins, so that surfaces with a common rim
  // leave no gap.
  struct Crossings {
    static constexpr int most = 16;
    std::array<double, most> t;
    int count = 0;
    void add(double at) {
      if (count < most) t[size_t(count++)] = at;
    }
  };
  Crossings intersect(const Vec3d& origin, const Vec3d& direction) const;

  // Returns the point of the surface at a hit: moves a point that is near the surface along the
  // ray, or along the normal where the ray grazes. The residual is that of double precision.
  Vec3d settle(const Vec3d& point, const Vec3d& direction) const;

  // Sampling by area, for surfaces of revolution about an axis of their own frame: aspheres, and
  // quadrics like cylinders and cones. pointAt() maps the unit square to the surface. areaAt()
  // returns the area of an element about a point of the surface over that of its element in the
  // unit square: 1 / pdf by area; 0 where pointAt() has left the surface.
  bool samplable() const { return axis_ >= 0; }
  Vec3d pointAt(double u, double v) const;
  double areaAt(const Vec3d& p) const;

  // Returns the texture coordinates of a point. Quadrics: as VRML's Cylinder and Cone (ISO/IEC
  // 14772-1 6.11, 6.14), s around the y axis from the back, t along y from the lower to the upper
  // side of the box. Aspheres: a square about the aperture, s along x and t along y.
  std::array<double, 2> texCoordAt(const Vec3d& p) const;
  // Returns the derivatives of the position by the texture coordinates; 0 where they have none.
  struct Tangents {
    Vec3d alongS, alongT;
  };
  Tangents tangentsAt(const Vec3d& p) const;

 private:
  struct Segment { // a piece of a line: anchor + t * unit, for t from `from` to `to`
    Vec3d anchor, unit;
    double from, to;
    double offset, length; // distance from the origin = (offset + t) / length of the direction
  };
  void setBounds();
  int axisOfRevolution() const;
  double squaredRadius(double t, double& slope) const; // slope: its derivative
  double number(size_t i) const { return numbers_[i]; }
  double curvature() const { return numbers_[0]; }
  double conic() const { return numbers_[1]; }
  double inner() const { return numbers_[2]; }
  double outer() const { return numbers_[3]; }
  size_t terms() const { return count_ - 4; }
  bool polynomial() const { return kind_ == edit::Primitive::Asphere && terms() > 0; }
  double sagOf(double square) const;    // square: of the radius
  double sagSlope(double square) const; // derivative of the sag by the square of the radius
  double slopeBound(double from, double to, bool upper) const;
  bool clip(const Vec3d& origin, const Vec3d& direction, Segment& out, double& slack) const;
  bool accepts(const Vec3d& p, double slack) const;
  void crossQuadratic(const Segment& s, double slack, Crossings& out) const;
  void crossPolynomial(const Segment& s, double slack, Crossings& out) const;

  edit::Primitive kind_;
  std::array<double, 16> numbers_{};
  size_t count_ = 0;
  std::array<double, 10> form_{}; // coefficients of a quadric, or an asphere without a polynomial
  Vec3d low_, high_;
  double size_ = 0; // largest edge of the bounds
  int axis_ = -1;   // the axis of revolution; -1: none that is known
};

} // namespace openrt
