// ray_order.cpp: finds the rows of an array of rays, and cuts them into patches (ray_order.h).
#include "backend/local/ray_order.h"

#include <algorithm>
#include <cmath>

#include "scene/vec3.h"

namespace openrt {
namespace {

constexpr uint32_t packet = 16;

size_t blocksOf(size_t count, size_t size) { return (count + size - 1) / size; }

} // namespace

RayOrder::RayOrder(std::span<const RTray> rays, float sceneSize) : count_(rays.size()) {
  if (sceneSize > 0) originWeight_ = 1 / (double(sceneSize) * double(sceneSize));
  if (!findRows(rays)) end_ = 0;
  after_ = blocksOf(count_ - end_, most);
  if (end_ == 0) return;
  columns_ = most / down_;
  bands_ = end_ / (width_ * down_);
  bandBlocks_ = blocksOf(width_, columns_);
}

// Returns a measure of how far two rays run apart. NaN if one of them has no direction.
double RayOrder::squareBetween(const RTray& a, const RTray& b) const {
  const Vec3d d(vectorOf(a.direction)),
      turn = Vec3d(vectorOf(b.direction)) - d,
      shift = Vec3d(vectorOf(b.origin)) - Vec3d(vectorOf(a.origin));
  return dot(turn, turn) / dot(d, d) + originWeight_ * dot(shift, shift);
}

// Returns after how many rays the array comes back to the side of its first ray; 0 if it does not.
// On the way it must have been four times as far from there.
size_t RayOrder::findPeriod(std::span<const RTray> rays) const {
  double farthest = 0;
  for (size_t i = 1; i <= rays.size() / 2; i++) {
    const double here = squareBetween(rays[0], rays[i]);
    farthest = std::max(farthest, here);
    if (i < packet || !(here * 16 < farthest)) continue;
    // It comes nearer until the first ray of the next row.
    size_t k = i;
    while (k + 1 < rays.size() &&
           squareBetween(rays[0], rays[k + 1]) < squareBetween(rays[0], rays[k]))
      k++;
    return k;
  }
  return 0;
}

// Sets the rows and the shape of the patches. Where it errs, only time is lost.
bool RayOrder::findRows(std::span<const RTray> rays) {
  constexpr size_t samples = 8;
  if (rays.size() < 4 * packet) return false;
  // Incoherent rays are told by their first ones.
  if (!(squareBetween(rays[0], rays[1]) < 0.01)) return false;
  width_ = findPeriod(rays);
  if (width_ < packet || width_ * 2 > rays.size()) return false;
  double along = 0, down = 0;
  for (size_t s = 0; s < samples; s++) {
    const size_t i = s * (rays.size() - width_ - 1) / samples;
    const double row = squareBetween(rays[i], rays[i + width_]);
    // A ray is nearer to the one below it than to the next packet of its row.
    if (!(row < 4 * squareBetween(rays[i], rays[i + packet / 2]) || row < 0.01)) return false;
    along += std::sqrt(squareBetween(rays[i], rays[i + 1])) / samples;
    down += std::sqrt(row) / samples;
  }
  double least = HUGE_VAL;
  for (uint32_t rows = 1; rows <= packet; rows *= 2) {
    const double extent = std::max(along * (packet / rows), down * rows);
    if (!(extent < least)) continue;
    least = extent;
    down_ = rows;
    across_ = packet / rows;
  }
  end_ = rays.size() / (width_ * down_) * (width_ * down_);
  return down_ > 1;
}

void RayOrder::get(size_t block, Block& to) const {
  if (block >= bands_ * bandBlocks_) {
    to.first = end_ + (block - bands_ * bandBlocks_) * most;
    to.count = uint32_t(std::min<size_t>(most, count_ - to.first));
    for (uint32_t i = 0; i < to.count; i++) to.offset[i] = i;
    return;
  }
  const size_t column = block % bandBlocks_ * columns_,
               columns = std::min<size_t>(columns_, width_ - column);
  to.first = block / bandBlocks_ * down_ * width_ + column;
  to.count = 0;
  for (size_t left = 0; left < columns; left += across_)
    for (size_t row = 0; row < down_; row++)
      for (size_t x = left; x < std::min(left + across_, columns); x++)
        to.offset[to.count++] = uint32_t(row * width_ + x);
}

} // namespace openrt
