#include "mapper/outermost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace xvrml::mapper {

// The directions are those of a spiral.
Outermost::Directions Outermost::even() {
  Directions directions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (size_t i = 0; i < count; ++i) {
    const double z = (double(i) + 0.5) / double(count), radius = std::sqrt(1 - z * z);
    directions[i] = {radius * std::cos(golden * double(i)), radius * std::sin(golden * double(i)),
                     z};
  }
  return directions;
}

Outermost::Outermost(const Directions& directions) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < count; ++i) {
    x_[i] = directions[i].x;
    y_[i] = directions[i].y;
    z_[i] = directions[i].z;
  }
  least_.fill(infinity);
  most_.fill(-infinity);
}

void Outermost::add(const Vector& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) return;
  block_[inBlock_++] = point;
  if (inBlock_ == blockSize) addBlock();
}

void Outermost::addBlock() {
  const size_t end = std::exchange(inBlock_, 0);
  if (end == 0) return;
  Vector low = block_[0], high = block_[0];
  for (size_t p = 1; p < end; ++p)
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], block_[p][k]);
      high[k] = std::max(high[k], block_[p][k]);
    }
  if (!mayBeOutside(low, high)) return;
  for (size_t p = 0; p < end; ++p) compare(block_[p]);
}

// Returns whether a point of a box may lie farther out than those that are known, in any direction.
bool Outermost::mayBeOutside(const Vector& low, const Vector& high) const {
  const Vector center = low / 2 + high / 2;
  Vector half = high / 2 - low / 2;
  double size = 0;
  for (int k = 0; k < 3; ++k) size += std::abs(center[k]) + half[k];
  half += Vector(1e-12 * size); // for the rounding of sums
  int inside = 1;
  for (size_t i = 0; i < count; ++i) {
    const double along = x_[i] * center.x + y_[i] * center.y + z_[i] * center.z,
                 reach =
                     std::abs(x_[i]) * half.x + std::abs(y_[i]) * half.y + std::abs(z_[i]) * half.z;
    inside &= int(along - reach >= least_[i]) & int(along + reach <= most_[i]);
  }
  return !inside; // also for sums that are not finite
}

// Most points lie within what is known, so the loop that finds this has no branches.
void Outermost::compare(const Vector& point) {
  std::array<double, count> along;
  int outside = 0;
  for (size_t i = 0; i < count; ++i) {
    along[i] = x_[i] * point.x + y_[i] * point.y + z_[i] * point.z;
    outside |= int(along[i] < least_[i]) | int(along[i] > most_[i]);
  }
  if (!outside) return;
  for (size_t i = 0; i < count; ++i) {
    if (along[i] < least_[i]) {
      least_[i] = along[i];
      first_[i] = point;
    }
    if (along[i] > most_[i]) {
      most_[i] = along[i];
      last_[i] = point;
    }
  }
}

// An ellipsoid M(sphere) lies farthest along d where M takes the point of the sphere along M^T d.
void Outermost::addSphere(const Matrix& matrix, double radius) {
  const Vector center = transformPoint(matrix, Vector(0));
  for (size_t i = 0; i < count; ++i) {
    Vector inner;
    for (int k = 0; k < 3; ++k)
      inner[k] =
          Vector(matrix.x[k][0], matrix.x[k][1], matrix.x[k][2]).dot(Vector(x_[i], y_[i], z_[i]));
    const double length = inner.length();
    if (!(length > 0)) continue;
    const Vector out = transformDirection(matrix, inner * (radius / length));
    add(center + out);
    add(center - out);
  }
}

std::vector<Vector> Outermost::points() {
  addBlock();
  std::vector<Vector> all;
  if (most_[0] < least_[0]) return all;
  all.reserve(2 * count);
  all.insert(all.end(), first_.begin(), first_.end());
  all.insert(all.end(), last_.begin(), last_.end());
  return all;
}

} // namespace xvrml::mapper
