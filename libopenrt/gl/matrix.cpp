// matrix.cpp: Computes the matrices of OpenGL 1.1 (specification, section 2.10) and of gluLookAt.
#include "gl/matrix.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace rtgl {

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix m;
  for (size_t column = 0; column < 4; column++)
    for (size_t row = 0; row < 4; row++) {
      double sum = 0;
      for (size_t k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      m[4 * column + row] = sum;
    }
  return m;
}

Matrix translation(double x, double y, double z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

Matrix scaling(double x, double y, double z) {
  return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1};
}

Matrix rotation(double degrees, double x, double y, double z) {
  const Vector a = unit({x, y, z});
  if (length(a) == 0) return identity;
  const double angle = std::remainder(degrees, 360.0) * (std::numbers::pi / 180);
  const double s = std::sin(angle), c = std::cos(angle), d = 1 - c;
  return {a[0] * a[0] * d + c,
          a[1] * a[0] * d + a[2] * s,
          a[0] * a[2] * d - a[1] * s,
          0,
          a[0] * a[1] * d - a[2] * s,
          a[1] * a[1] * d + c,
          a[1] * a[2] * d + a[0] * s,
          0,
          a[0] * a[2] * d + a[1] * s,
          a[1] * a[2] * d - a[0] * s,
          a[2] * a[2] * d + c,
          0,
          0,
          0,
          0,
          1};
}

Matrix frustum(double l, double r, double b, double t, double n, double f) {
  return {2 * n / (r - l),
          0,
          0,
          0,
          0,
          2 * n / (t - b),
          0,
          0,
          (r + l) / (r - l),
          (t + b) / (t - b),
          -(f + n) / (f - n),
          -1,
          0,
          0,
          -2 * f * n / (f - n),
          0};
}

Matrix ortho(double l, double r, double b, double t, double n, double f) {
  return {2 / (r - l),
          0,
          0,
          0,
          0,
          2 / (t - b),
          0,
          0,
          0,
          0,
          -2 / (f - n),
          0,
          -(r + l) / (r - l),
          -(t + b) / (t - b),
          -(f + n) / (f - n),
          1};
}

Matrix lookAt(const Vector& eye, const Vector& at, const Vector& up) {
  const Vector forward = unit(at - eye);
  const Vector side = unit(cross(forward, up));
  const Vector above = cross(side, forward);
  const Matrix turn = {side[0], above[0], -forward[0], 0, side[1], above[1], -forward[1], 0,
                       side[2], above[2], -forward[2], 0, 0,       0,        0,           1};
  return turn * translation(-eye[0], -eye[1], -eye[2]);
}

bool invert(const Matrix& m, Matrix& out) {
  Matrix a = m;
  out = identity;
  for (size_t k = 0; k < 4; k++) { // Gauss and Jordan, with the largest pivot of the column
    size_t pivot = k;
    for (size_t row = k + 1; row < 4; row++)
      if (std::abs(a[4 * k + row]) > std::abs(a[4 * k + pivot])) pivot = row;
    if (!(std::abs(a[4 * k + pivot]) > 0)) return false;
    for (size_t column = 0; column < 4; column++) {
      std::swap(a[4 * column + k], a[4 * column + pivot]);
      std::swap(out[4 * column + k], out[4 * column + pivot]);
    }
    const double scale = 1 / a[4 * k + k];
    for (size_t column = 0; column < 4; column++) {
      a[4 * column + k] *= scale;
      out[4 * column + k] *= scale;
    }
    for (size_t row = 0; row < 4; row++) {
      if (row == k) continue;
      const double factor = a[4 * k + row];
      for (size_t column = 0; column < 4; column++) {
        a[4 * column + row] -= factor * a[4 * column + k];
        out[4 * column + row] -= factor * out[4 * column + k];
      }
    }
  }
  return finite(out);
}

std::array<double, 4> transform(const Matrix& m, const std::array<double, 4>& p) {
  std::array<double, 4> r;
  for (size_t row = 0; row < 4; row++)
    r[row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row] * p[3];
  return r;
}

Vector project(const Matrix& m, const Vector& p) {
  const std::array<double, 4> h = transform(m, {p[0], p[1], p[2], 1});
  return {h[0] / h[3], h[1] / h[3], h[2] / h[3]};
}

bool affine(const Matrix& m) { return m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1; }

bool finite(const Matrix& m) {
  for (double value : m)
    if (!std::isfinite(value)) return false;
  return true;
}

bool mirrors(const Matrix& m) {
  const Vector x = {m[0], m[1], m[2]}, y = {m[4], m[5], m[6]}, n = cross(x, y);
  return n[0] * m[8] + n[1] * m[9] + n[2] * m[10] < 0;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Vector unit(const Vector& v) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : v;
}

} // namespace rtgl
