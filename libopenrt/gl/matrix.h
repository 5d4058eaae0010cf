// matrix.h: 4x4 matrices of OpenGL, column-major, in double precision. Pure functions.
#pragma once

#include <array>

namespace rtgl {

using Matrix = std::array<double, 16>;
using Vector = std::array<double, 3>;

inline constexpr Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix operator*(const Matrix& a, const Matrix& b);
Matrix translation(double x, double y, double z);
Matrix scaling(double x, double y, double z);
// Turns by degrees about an axis. An axis of 0 0 0 gives the identity.
Matrix rotation(double degrees, double x, double y, double z);
Matrix frustum(double left, double right, double bottom, double top, double near, double far);
Matrix ortho(double left, double right, double bottom, double top, double near, double far);
// Returns the world-to-eye matrix of gluLookAt.
Matrix lookAt(const Vector& eye, const Vector& at, const Vector& up);
// Writes the inverse. Returns false if the matrix is singular.
bool invert(const Matrix& m, Matrix& out);
// Returns m applied to a homogeneous point.
std::array<double, 4> transform(const Matrix& m, const std::array<double, 4>& point);
// Returns m applied to a point, after the division by w.
Vector project(const Matrix& m, const Vector& point);
// Returns whether the bottom row is 0 0 0 1.
bool affine(const Matrix& m);
bool finite(const Matrix& m);
// Returns whether the matrix turns left hands into right ones.
bool mirrors(const Matrix& m);

inline Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector operator*(double s, const Vector& v) { return {s * v[0], s * v[1], s * v[2]}; }
Vector cross(const Vector& a, const Vector& b);
double length(const Vector& v);
// Returns the vector with length 1; 0 0 0 stays as it is.
Vector unit(const Vector& v);

} // namespace rtgl
