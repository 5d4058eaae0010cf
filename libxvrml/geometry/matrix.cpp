// matrix.cpp: composes the standard's transformations.
#include "geometry/matrix.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "rotation.h"

namespace xvrml {

Matrix fromArray(const double m[16]) {
  Matrix out;
  std::memcpy(&out.x[0][0], m, sizeof out.x);
  return out;
}

void toArray(const Matrix& m, double out[16]) { std::memcpy(out, &m.x[0][0], sizeof m.x); }

Matrix translation(const Vector& v) {
  Matrix m;
  m.x[3][0] = v.x;
  m.x[3][1] = v.y;
  m.x[3][2] = v.z;
  return m;
}

Matrix scaling(const Vector& v) {
  Matrix m;
  m.x[0][0] = v.x;
  m.x[1][1] = v.y;
  m.x[2][2] = v.z;
  return m;
}

Matrix rotation(const Vector& axis, double angle) {
  const double length = axis.length();
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(angle) || angle == 0) return {};
  const Vector a = axis / length;
  return rotationMatrix<Matrix>(a, std::sin(angle), std::cos(angle));
}

Matrix rotation(const Rotation& r) { return rotation(Vector(r.x, r.y, r.z), r.angle); }

Matrix transformMatrix(const TransformFields& f) {
  const bool scales = f.scale != Vec3f{1, 1, 1};
  // Most Transforms only translate. This is the same matrix as below.
  if (!scales && f.rotation.angle == 0 && f.center == Vec3f())
    return translation(vector(f.translation));
  Matrix m = compose(translation(vector(f.translation) + vector(f.center)), rotation(f.rotation));
  if (scales) {
    const Rotation& o = f.scaleOrientation;
    m = compose(m,
                compose(rotation(o), compose(scaling(vector(f.scale)),
                                             rotation(Vector(o.x, o.y, o.z), -double(o.angle)))));
  }
  return compose(m, translation(-vector(f.center)));
}

Matrix textureMatrix(Vec2f center, float angle, Vec2f scale, Vec2f offset) {
  const Matrix c = translation({center.x, center.y, 0}),
               back = translation({-double(center.x), -double(center.y), 0});
  const Matrix turn = compose(scaling({scale.x, scale.y, 1}), rotation(Vector(0, 0, 1), angle));
  return compose(compose(back, turn), compose(c, translation({offset.x, offset.y, 0})));
}

Vector transformDirection(const Matrix& m, const Vector& v) {
  return {v.x * m.x[0][0] + v.y * m.x[1][0] + v.z * m.x[2][0],
          v.x * m.x[0][1] + v.y * m.x[1][1] + v.z * m.x[2][1],
          v.x * m.x[0][2] + v.y * m.x[1][2] + v.z * m.x[2][2]};
}

Vector transformPoint(const Matrix& m, const Vector& p) {
  return transformDirection(m, p) + Vector(m.x[3][0], m.x[3][1], m.x[3][2]);
}

bool finite(const Matrix& m) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(data(m)[i])) return false;
  return true;
}

namespace {
Vector row(const Matrix& m, int i) { return {m.x[i][0], m.x[i][1], m.x[i][2]}; }

Matrix frame(const Vector& x, const Vector& y, const Vector& z, const Vector& origin) {
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

// Returns a unit vector perpendicular to the unit vector v.
Vector perpendicular(const Vector& v) {
  const Vector axis = std::abs(v.x) < 0.6 ? Vector(1, 0, 0) : Vector(0, 1, 0);
  return (axis - v * axis.dot(v)).normalized();
}

// Completes a unit z to a frame with y as close to `up` as possible.
Matrix frameAbout(const Vector& z, const Vector& up, const Vector& origin) {
  Vector y = up - z * up.dot(z);
  y = y.length() > 1e-9 * up.length() ? y.normalized() : perpendicular(z);
  return frame(y.cross(z), y, z, origin);
}
} // namespace

double determinant(const Matrix& m) {
  const double d = row(m, 0).dot(row(m, 1).cross(row(m, 2)));
  return std::isfinite(d) && finite(m) ? d : 0;
}

double largestStretch(const Matrix& m) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, row(m, i).length());
  if (!(longest > 0) || !std::isfinite(longest)) return longest;
  // The squared singular values are the eigenvalues of this symmetric matrix.
  double g[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) g[i][j] = (row(m, i) / longest).dot(row(m, j) / longest);
  // Rotations and scales leave only rounding errors beside the diagonal.
  const double shear = std::abs(g[0][1]) + std::abs(g[0][2]) + std::abs(g[1][2]);
  if (!(shear > 1e-12)) return longest;
  // O. K. Smith, "Eigenvalues of a symmetric 3 x 3 matrix", CACM 4(4), 1961.
  const double mean = (g[0][0] + g[1][1] + g[2][2]) / 3;
  for (int i = 0; i < 3; ++i) g[i][i] -= mean;
  double squares = 0;
  for (const auto& line : g)
    for (const double x : line) squares += x * x;
  const double p = std::sqrt(squares / 6);
  const double det = g[0][0] * (g[1][1] * g[2][2] - g[1][2] * g[2][1]) -
                     g[0][1] * (g[1][0] * g[2][2] - g[1][2] * g[2][0]) +
                     g[0][2] * (g[1][0] * g[2][1] - g[1][1] * g[2][0]);
  const double angle = std::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3;
  return longest * std::max(1.0, std::sqrt(mean + 2 * p * std::cos(angle)));
}

bool invert(const Matrix& m, Matrix& inverse) {
  const double d = determinant(m);
  if (d == 0) return false;
  const Vector a = row(m, 0), b = row(m, 1), c = row(m, 2);
  const Vector bc = b.cross(c) / d, ca = c.cross(a) / d, ab = a.cross(b) / d;
  inverse = Matrix(bc.x, ca.x, ab.x, 0, bc.y, ca.y, ab.y, 0, bc.z, ca.z, ab.z, 0, 0, 0, 0, 1);
  const Vector t = transformDirection(inverse, row(m, 3));
  inverse.x[3][0] = -t.x;
  inverse.x[3][1] = -t.y;
  inverse.x[3][2] = -t.z;
  return finite(inverse);
}

Matrix rigid(const Matrix& m) {
  if (!finite(m)) return {};
  const Vector z = row(m, 2), y = row(m, 1);
  if (z.length() > 0)
    return frameAbout(z.normalized(), y.length() > 0 ? y : Vector(0, 1, 0), row(m, 3));
  return translation(row(m, 3));
}

Matrix rotationOnly(const Matrix& m) {
  Matrix r = rigid(m);
  r.x[3][0] = r.x[3][1] = r.x[3][2] = 0;
  return r;
}

Matrix billboardMatrix(const Vector& axisOfRotation, const Vector& viewer, const Vector& up) {
  const double distance = viewer.length();
  if (!(distance > 0) || !std::isfinite(distance)) return {};
  if (!(axisOfRotation.length() > 0))
    return frameAbout(viewer / distance, up.length() > 0 ? up : Vector(0, 1, 0), Vector(0));
  // Rotate about the axis until the local z axis lies in the plane of the axis and the viewer.
  const Vector a = axisOfRotation.normalized();
  const Vector z(0, 0, 1), zFlat = z - a * a.dot(z), vFlat = viewer - a * a.dot(viewer);
  if (zFlat.length() < 1e-9 || vFlat.length() < 1e-9 * distance) return {};
  return rotation(a, std::atan2(a.dot(zFlat.cross(vFlat)), zFlat.dot(vFlat)));
}

double verticalFieldOfView(double fieldOfView, double aspect) {
  double f = fieldOfView > 0 && fieldOfView < std::numbers::pi ? fieldOfView : std::numbers::pi / 4;
  if (aspect > 0 && aspect < 1) f = 2 * std::atan(std::tan(f / 2) / aspect);
  return std::min(f, 3.14);
}

} // namespace xvrml
