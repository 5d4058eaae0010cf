// search_frame.cpp: the way of a ray through a SearchFrame, with the bound of its error.
#include "backend/local/double/search_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace openrt {
namespace {

using Long = Vec3<long double>;

// A few units of the last place: more than the sums below round by.
constexpr long double rounding = 8 * std::numeric_limits<long double>::epsilon();
// This is what the boxes allow for (padding in candidates.cpp), less what the conversion to float
// takes.
constexpr long double mostError = 0x1p-21L;
// With an error below this, rays that pass the ball of radius 2 pass the cube within it.
constexpr long double mostForBall = 0.125L;

long double sumOf(const Long& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }

// The squares of the singular values of the matrix with the rows x, y, z are the eigenvalues of the
// matrix of their products; the largest one has a closed form (O. Smith, Eigenvalues of a symmetric
// 3 x 3 matrix, CACM 4(4), 1961).
double largestStretch(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const double xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), xy = dot(x, y), yz = dot(y, z),
               zx = dot(z, x), mean = (xx + yy + zz) / 3;
  const Vec3d off{xx - mean, yy - mean, zz - mean};
  const double p = std::sqrt((dot(off, off) + 2 * (xy * xy + yz * yz + zx * zx)) / 6);
  if (!(p > 0)) return std::sqrt(mean);
  const Vec3d a{off.x, xy, zx}, b{xy, off.y, yz}, c{zx, yz, off.z};
  const double r = std::clamp(dot(a, cross(b, c)) / (2 * p * p * p), -1.0, 1.0);
  return std::sqrt(mean + 2 * p * std::cos(std::acos(r) / 3));
}

} // namespace

SearchFrame::SearchFrame(const Matrix4d& toWorld, const Vec3d& center, double unit) {
  const Long x(toWorld.column(0)), y(toWorld.column(1)), z(toWorld.column(2)), c(center);
  const Long shift(toWorld.translation());
  center_ = shift + x * c.x + y * c.y + z * c.z;
  centerError_ = rounding * (largest(abs(shift)) + largest(abs(x)) * std::fabs(c.x) +
                             largest(abs(y)) * std::fabs(c.y) + largest(abs(z)) * std::fabs(c.z));
  const Long yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const long double determinant = dot(x, yz), factor = unit / determinant;
  inverse_ = {yz * factor, zx * factor, xy * factor};
  const auto extent = [](const Long& v) { return largest(abs(v)); };
  const long double products =
      std::max({extent(y) * extent(z), extent(z) * extent(x), extent(x) * extent(y)});
  size_ = std::max({sumOf(inverse_.x), sumOf(inverse_.y), sumOf(inverse_.z)});
  // The determinant errs by its products, and so does every row by its own.
  const long double relative =
      rounding * 6 * extent(x) * extent(y) * extent(z) / std::fabs(determinant);
  stretch_ = largestStretch(Vec3d(inverse_.x), Vec3d(inverse_.y), Vec3d(inverse_.z)) * (1 + 1e-6);
  inverseError_ = 6 * rounding * products * std::fabs(factor) + 2 * relative * size_;
}

SearchFrame::Spot SearchFrame::spotOf(const Vec3d& point) const {
  const Long from = Long(point) - center_;
  const long double extent = largest(abs(Long(point))) + largest(abs(center_)),
                    error = inverseError_ * largest(abs(from)) +
                            size_ * (centerError_ + rounding * extent);
  return {Vec3d(inverse_ * from), double(error)};
}

SearchFrame::Way SearchFrame::wayOf(const DoubleRay& ray, double far) const {
  const Long from = Long(ray.origin) - center_, along(ray.direction);
  const Long origin = inverse_ * from, direction = inverse_ * along;
  const long double length = std::sqrt(dot(direction, direction)),
                    middle = -dot(origin, direction) / (length * length);
  const Long closest = origin + direction * middle;
  // The errors of origin and direction, and what they make at the far end of the way.
  const long double extent = largest(abs(Long(ray.origin))) + largest(abs(center_)),
                    reach = std::min<long double>(far, std::fabs(middle) + 2 / length),
                    turn = (inverseError_ + rounding * size_) * largest(abs(along)),
                    error = inverseError_ * largest(abs(from)) +
                            size_ * (centerError_ + rounding * extent) + reach * turn;
  Way way;
  way.search = Search::all;
  if (!(error <= mostForBall)) {
    // A ball that is larger by twice the error holds the true way, unless the direction errs by
    // more than a quarter; or nothing is known.
    const long double radius = 2 + 2 * error;
    const bool passes = 4 * turn <= length && dot(closest, closest) > radius * radius;
    if (passes) way.search = Search::none;
    return way;
  }
  const long double start = std::max<long double>(ray.near, middle - 2 / length),
                    end = std::min<long double>(far, middle + 2 / length);
  if (!(dot(closest, closest) <= 4) || !(start <= end)) {
    way.search = Search::none;
    return way;
  }
  if (error <= mostError) way.search = Search::boxes;
  way.start = double(start);
  way.length = double(length);
  way.ray = {Vec3d(origin + direction * way.start), Vec3d(direction / length), 0,
             way.fromRay(double(end))};
  return way;
}

} // namespace openrt
