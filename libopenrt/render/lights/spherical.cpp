#include "render/lights/spherical.h"

#include <algorithm>

#include "render/frame.h"

namespace openrt {
namespace {

double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

bool normalize(double v[3]) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0) || !std::isfinite(length)) return false;
  const double scale = 1 / length;
  for (int k = 0; k < 3; k++) v[k] *= scale;
  return true;
}

// Computes the direction about an axis with the cosine 1 - below.
void aboutAxis(const double axis[3], double below, double turn, double out[3]) {
  double s[3], t[3];
  basisOf(axis, s, t);
  const double sine = std::sqrt(std::max(0.0, below * (2 - below))), phi = 2 * M_PI * turn;
  const double x = sine * std::cos(phi), y = sine * std::sin(phi), z = 1 - below;
  for (int k = 0; k < 3; k++) out[k] = x * s[k] + y * t[k] + z * axis[k];
}

} // namespace

SphericalTriangle::SphericalTriangle(const float corner[3][3], const float eye[3]) {
  double a[3], b[3];
  for (int k = 0; k < 3; k++) {
    a[k] = double(corner[1][k]) - corner[0][k];
    b[k] = double(corner[2][k]) - corner[0][k];
    for (int c = 0; c < 3; c++) corner_[c][k] = double(corner[c][k]) - eye[k];
  }
  cross(a, b, normal_);
  height_ = dot(corner_[0], normal_);
  const double c[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
  const double square[3] = {dot(corner_[0], corner_[0]), dot(corner_[1], corner_[1]),
                            dot(corner_[2], corner_[2])};
  const double nearest = std::min({square[0], square[1], square[2]}),
               farthest = std::max({square[0], square[1], square[2]});
  far_ = nearest > 4 * longest && farthest < 2 * nearest;
  if (!std::isfinite(height_)) height_ = 0;
  if (!far_) computeSolidAngle();
}

void SphericalTriangle::computeSolidAngle() {
  double size = 1;
  for (int c = 0; c < 3; c++) {
    const double length = std::sqrt(dot(corner_[c], corner_[c]));
    const double scale = 1 / length;
    for (int k = 0; k < 3; k++) unit_[c][k] = corner_[c][k] * scale;
    size *= length;
  }
  if (!(size > 0) || !std::isfinite(size)) return; // also if a length was 0
  volume_ = std::fabs(height_) / size;
  others_ = dot(unit_[0], unit_[2]) + dot(unit_[1], unit_[2]);
  first_ = 1 + dot(unit_[0], unit_[1]);
  if (volume_ > 0) solidAngle_ = 2 * std::atan2(volume_, others_ + first_);
}

double SphericalTriangle::solidAngle() const {
  if (!far_) return solidAngle_;
  SphericalTriangle near = *this;
  near.computeSolidAngle();
  return near.solidAngle_;
}

double SphericalTriangle::distanceAlong(const double d[3]) const {
  return height_ / dot(normal_, d);
}

bool SphericalTriangle::sample(double u, double v, double direction[3], double& distance) const {
  if (far_) {
    if (height_ == 0) return false;
    const double root = std::sqrt(u), w[3] = {1 - root, root * (1 - v), root * v};
    for (int k = 0; k < 3; k++)
      direction[k] = w[0] * corner_[0][k] + w[1] * corner_[1][k] + w[2] * corner_[2][k];
    distance = std::sqrt(dot(direction, direction));
    return normalize(direction);
  }
  if (!(solidAngle_ > 0)) return false;
  // Selects the point on the arc from the first corner to the last that cuts off the fraction u of
  // the solid angle. Then selects a point on the arc from the second corner to that point.
  const double half = u * solidAngle_ / 2, c = std::cos(half), s = std::sin(half);
  const double x = volume_ * c - others_ * s, y = first_ * s;
  double r[3], end[3];
  for (int k = 0; k < 3; k++) r[k] = x * unit_[0][k] + y * unit_[2][k];
  const double square = dot(r, r), scale = square > 0 ? 2 * dot(unit_[0], r) / square : 0;
  for (int k = 0; k < 3; k++) end[k] = scale * r[k] - unit_[0][k];
  double across[3], span = 0; // span: 1 - cosine of the second arc, computed from its chord
  const double far = dot(unit_[1], end);
  for (int k = 0; k < 3; k++) {
    across[k] = end[k] - far * unit_[1][k];
    span += (end[k] - unit_[1][k]) * (end[k] - unit_[1][k]) / 2;
  }
  const double below = v * span, sine = std::sqrt(std::max(0.0, below * (2 - below)));
  if (!normalize(across)) return false;
  for (int k = 0; k < 3; k++) direction[k] = (1 - below) * unit_[1][k] + sine * across[k];
  if (!normalize(direction)) return false;
  distance = distanceAlong(direction);
  return distance > 0 && std::isfinite(distance);
}

double SphericalTriangle::pdf(const double direction[3]) const {
  if (!far_) return solidAngle_ > 0 ? 1 / solidAngle_ : 0;
  const double along = std::fabs(dot(normal_, direction)), distance = distanceAlong(direction);
  return height_ != 0 ? 2 * distance * distance / along
                      : 0; // squared distance over the projected area
}

SphericalEllipsoid::SphericalEllipsoid(const float toLocal[3][4], const float toRender[3][4],
                                       const float eye[3]) {
  for (int i = 0; i < 3; i++) {
    eye_[i] = toLocal[i][3];
    for (int k = 0; k < 3; k++) {
      toLocal_[i][k] = toLocal[i][k];
      toRender_[i][k] = toRender[i][k];
      eye_[i] += double(toLocal[i][k]) * eye[k];
    }
  }
  double c[3];
  cross(toLocal_[1], toLocal_[2], c);
  determinant_ = std::fabs(dot(toLocal_[0], c));
  const double square = dot(eye_, eye_);
  inside_ = !(square > 1);
  if (!inside_) cap_ = 1 / (square * (1 + std::sqrt(1 - 1 / square)));
}

// Samples the cone uniformly in the sphere's frame: a linear map M transforms solid angle there by
// |det M| / |M d|^3.
bool SphericalEllipsoid::sample(double u, double v, double direction[3], double& distance) const {
  if (inside_) return false;
  const double length = std::sqrt(dot(eye_, eye_)),
               axis[3] = {-eye_[0] / length, -eye_[1] / length, -eye_[2] / length};
  double local[3];
  aboutAxis(axis, u * cap_, v, local);
  for (int i = 0; i < 3; i++) direction[i] = dot(toRender_[i], local);
  const double scale = std::sqrt(dot(direction, direction));
  if (!normalize(direction)) return false;
  for (double& l : local) l /= scale;
  // The nearer of the two intersections along the line.
  const double a = dot(local, local), b = dot(eye_, local), c = dot(eye_, eye_) - 1;
  // Offset of the line from the centre. It is accurate also if the sphere is small and far away.
  double offset[3];
  for (int k = 0; k < 3; k++) offset[k] = eye_[k] - b / a * local[k];
  const double root = std::sqrt(std::max(0.0, (1 - dot(offset, offset)) * a));
  distance = c / (root - b);
  return distance > 0 && std::isfinite(distance);
}

double SphericalEllipsoid::pdf(const double direction[3]) const {
  if (inside_) return 0;
  double local[3];
  for (int i = 0; i < 3; i++) local[i] = dot(toLocal_[i], direction);
  const double square = dot(local, local);
  return determinant_ / (square * std::sqrt(square)) / (2 * M_PI * cap_);
}

} // namespace openrt
