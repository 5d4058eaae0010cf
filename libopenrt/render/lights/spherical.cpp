#include "render/lights/spherical.h"

#include <algorithm>
#include <cmath>

#include "render/orthonormal_basis.h"

namespace openrt {
namespace {

// Normalises a vector. Returns false if its length is 0 or not finite.
bool makeUnit(Vec3d& v) {
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size)) return false;
  v *= 1 / size;
  return true;
}

// Returns the direction about an axis with the cosine 1 - below.
Vec3d aboutAxis(const Vec3d& axis, double below, double turn) {
  Vec3d s, t;
  basisOf(axis, s, t);
  const double sine = std::sqrt(std::max(0.0, below * (2 - below))), phi = 2 * M_PI * turn;
  const double x = sine * std::cos(phi), y = sine * std::sin(phi), z = 1 - below;
  return x * s + y * t + z * axis;
}

} // namespace

SphericalTriangle::SphericalTriangle(const std::array<Vec3f, 3>& corner, const Vec3f& eye) {
  for (size_t c = 0; c < 3; c++) corner_[c] = Vec3d(corner[c]) - Vec3d(eye);
  const Vec3d a = Vec3d(corner[1]) - Vec3d(corner[0]), b = Vec3d(corner[2]) - Vec3d(corner[0]),
              c = a - b;
  normal_ = cross(a, b);
  height_ = dot(corner_[0], normal_);
  const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
  const Vec3d square{dot(corner_[0], corner_[0]), dot(corner_[1], corner_[1]),
                     dot(corner_[2], corner_[2])};
  const double nearest = smallest(square), farthest = largest(square);
  far_ = nearest > 4 * longest && farthest < 2 * nearest;
  if (!std::isfinite(height_)) height_ = 0;
  if (!far_) computeSolidAngle();
}

void SphericalTriangle::computeSolidAngle() {
  double size = 1;
  for (int c = 0; c < 3; c++) {
    const double distance = length(corner_[c]);
    unit_[c] = corner_[c] * (1 / distance);
    size *= distance;
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

double SphericalTriangle::distanceAlong(const Vec3d& d) const { return height_ / dot(normal_, d); }

bool SphericalTriangle::sample(double u, double v, Vec3d& direction, double& distance) const {
  if (far_) {
    if (height_ == 0) return false;
    const double root = std::sqrt(u);
    direction = (1 - root) * corner_[0] + root * (1 - v) * corner_[1] + root * v * corner_[2];
    distance = length(direction);
    return makeUnit(direction);
  }
  if (!(solidAngle_ > 0)) return false;
  // Selects the point on the arc from the first corner to the last that cuts off the fraction u of
  // the solid angle. Then selects a point on the arc from the second corner to that point.
  const double half = u * solidAngle_ / 2, c = std::cos(half), s = std::sin(half);
  const double x = volume_ * c - others_ * s, y = first_ * s;
  const Vec3d r = x * unit_[0] + y * unit_[2];
  const double square = dot(r, r), scale = square > 0 ? 2 * dot(unit_[0], r) / square : 0;
  const Vec3d end = scale * r - unit_[0], chord = end - unit_[1];
  const double span = dot(chord, chord) / 2; // 1 - cosine of the second arc
  const double below = v * span, sine = std::sqrt(std::max(0.0, below * (2 - below)));
  Vec3d across = end - dot(unit_[1], end) * unit_[1];
  if (!makeUnit(across)) return false;
  direction = (1 - below) * unit_[1] + sine * across;
  if (!makeUnit(direction)) return false;
  distance = distanceAlong(direction);
  return distance > 0 && std::isfinite(distance);
}

double SphericalTriangle::pdf(const Vec3d& direction) const {
  if (!far_) return solidAngle_ > 0 ? 1 / solidAngle_ : 0;
  const double along = std::fabs(dot(normal_, direction)), distance = distanceAlong(direction);
  return height_ != 0 ? 2 * distance * distance / along
                      : 0; // squared distance over the projected area
}

SphericalEllipsoid::SphericalEllipsoid(const Affine& toLocal, const Affine& toRender,
                                       const Vec3f& eye)
    : toLocal_(toLocal), toRender_(toRender), determinant_(std::fabs(determinantOf(toLocal))),
      eye_(toLocal.pointFromTranslation(Vec3d(eye))) {
  const double square = dot(eye_, eye_);
  inside_ = !(square > 1);
  if (!inside_) cap_ = 1 / (square * (1 + std::sqrt(1 - 1 / square)));
}

// Samples the cone uniformly in the sphere's frame: a linear map M transforms solid angle there by
// |det M| / |M d|^3.
bool SphericalEllipsoid::sample(double u, double v, Vec3d& direction, double& distance) const {
  if (inside_) return false;
  Vec3d local = aboutAxis(-eye_ / length(eye_), u * cap_, v);
  direction = toRender_.direction(local);
  const double scale = length(direction);
  if (!makeUnit(direction)) return false;
  local = local / scale;
  // The nearer of the two intersections along the line.
  const double a = dot(local, local), b = dot(eye_, local), c = dot(eye_, eye_) - 1;
  // Offset of the line from the centre. It is accurate also if the sphere is small and far away.
  const Vec3d offset = eye_ - b / a * local;
  const double root = std::sqrt(std::max(0.0, (1 - dot(offset, offset)) * a));
  distance = c / (root - b);
  return distance > 0 && std::isfinite(distance);
}

double SphericalEllipsoid::pdf(const Vec3d& direction) const {
  if (inside_) return 0;
  const Vec3d local = toLocal_.direction(direction);
  const double square = dot(local, local);
  return determinant_ / (square * std::sqrt(square)) / (2 * M_PI * cap_);
}

} // namespace openrt
