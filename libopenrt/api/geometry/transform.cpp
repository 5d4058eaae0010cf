// transform.cpp: Computes translation, scale, rotation and view matrices in double precision. Pure
// functions.
#include "api/geometry/transform.h"

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "api/errors.h"
#include "rotation.h"

namespace openrt {
namespace {

struct SineCosine {
  double sine, cosine;
};

// Exact at multiples of 90 degrees, so that four quarter turns give the identity.
SineCosine sineCosineOfDegrees(double degrees) {
  // angle reduced to -180..180 without rounding error
  const double reduced = std::remainder(degrees, 360.0);
  const double quarters = std::round(reduced / 90.0);
  // rest of -45 .. 45 degrees, in radians
  const double rest = (reduced - 90.0 * quarters) * (std::numbers::pi / 180.0);
  const double s = std::sin(rest), c = std::cos(rest);
  switch ((static_cast<int>(quarters) + 4) % 4) {
  case 0: return {s, c};
  case 1: return {c, -s};
  case 2: return {-s, -c};
  default: return {-c, s};
  }
}

bool allFinite(std::initializer_list<double> values) {
  for (double v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

Vec3d unit(const Vec3d& v, const char* complaint) {
  const double size = largest(abs(v));
  require(size > 0, RT_INVALID_VALUE, complaint);
  const Vec3d scaled = v / size; // no overflow or underflow in the squares
  return scaled * (1 / length(scaled));
}

} // namespace

Matrix4d checkedMatrix(const double* m) {
  require(m != nullptr, RT_INVALID_VALUE, "the matrix is NULL");
  Matrix4d matrix;
  for (int i = 0; i < 16; i++) matrix.m[i] = m[i];
  require(matrix.finite(), RT_INVALID_VALUE, "the matrix is not finite");
  require(m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1, RT_INVALID_VALUE,
          "the matrix is not affine: its bottom row must be 0 0 0 1");
  return matrix;
}

Matrix4d translation(double x, double y, double z) {
  Matrix4d matrix;
  matrix.m[12] = x;
  matrix.m[13] = y;
  matrix.m[14] = z;
  return matrix;
}

Matrix4d scaling(double x, double y, double z) {
  Matrix4d matrix;
  matrix.m[0] = x;
  matrix.m[5] = y;
  matrix.m[10] = z;
  return matrix;
}

Matrix4d rotation(double degrees, double x, double y, double z) {
  require(allFinite({degrees, x, y, z}), RT_INVALID_VALUE, "angle or axis is not finite");
  const Vec3d a = unit({x, y, z}, "the axis of rotation is 0 0 0");
  const auto [s, c] = sineCosineOfDegrees(degrees);
  Matrix4d r;
  r.m = rotationMatrix<decltype(r.m)>(a, s, c);
  return r;
}

Matrix4d lookAt(const Vec3d& eye, const Vec3d& at, const Vec3d& up) {
  require(allFinite({eye.x, eye.y, eye.z, at.x, at.y, at.z, up.x, up.y, up.z}), RT_INVALID_VALUE,
          "a coordinate is not finite");
  const Vec3d back = unit(eye - at, "eye and reference point coincide");
  const Vec3d right = unit(cross(unit(up, "the up vector is 0 0 0"), back),
                           "the up vector is parallel to the line of sight");
  const Vec3d above = cross(back, right);
  Matrix4d r;
  r.m = {right.x, right.y, right.z, 0, above.x, above.y, above.z, 0,
         back.x,  back.y,  back.z,  0, eye.x,   eye.y,   eye.z,   1};
  return r;
}

} // namespace openrt
