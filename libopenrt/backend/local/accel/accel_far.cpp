// accel_far.cpp: moves rays that begin so far away, or whose direction is so long, that their
// numbers would leave the range of the kernels in the frame of a small instance. Embree ends the
// process on such a ray. Called by render threads and the threads of queries.
#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/packet_lanes.h"

namespace openrt {
namespace {

constexpr double most = 1e18; // coordinates of rays that can be asked about
constexpr float mostFinite = std::numeric_limits<float>::max();

} // namespace

// The new origin lies before a sphere about the scene, and the direction has the length 1.
uint32_t Accel::moveNear(const Rays& rays, const float* ends, uint32_t first, uint32_t size,
                         int* valid, const PacketRays& to, FarRays& far) const {
  const Vec3d low(low_), high(high_);
  const Vec3d center = (low + high) * (0.5 * double(scale_));
  const double radius = length(high - low) * double(scale_); // twice that of the scene
  uint32_t refused = 0;
  for (uint32_t i = 0; i < size && first + i < rays.count; i++) {
    if (valid[i]) continue;
    const Vec3d origin = Vec3d(load(rays.org, first + i)) * double(scale_),
                given(load(rays.dir, first + i));
    const double size1 = dot(abs(given), Vec3d{1, 1, 1}), near = double(rays.tnear[first + i]),
                 end = double(ends[i]);
    if (!(isFinite(origin) && largest(abs(origin)) <= most && size1 > 0 && size1 <= most &&
          near >= 0 && near <= end && near <= double(mostFinite))) {
      refused++;
      continue;
    }
    const double stretch = length(given);
    const Vec3d direction = given / stretch, towards = center - origin;
    const double along = dot(towards, direction), shift = std::max(0.0, along - radius),
                 perLength = stretch * double(scale_);
    const double from = std::max(0.0, near * perLength - shift), until = end * perLength - shift;
    const bool meets = length(towards - direction * along) <= radius && along >= -radius;
    if (!meets || !(from <= until) || !(from <= most)) continue;
    const Vec3f start(origin + direction * shift), unit(direction);
    for (size_t k = 0; k < 3; k++) {
      to.org[k][i] = start[k];
      to.dir[k][i] = unit[k];
    }
    to.tnear[i] = float(from);
    to.tfar[i] = float(until);
    valid[i] = -1;
    far.lanes |= 1u << i;
    far.shift[i] = shift;
    far.perLength[i] = perLength;
  }
  return refused;
}

} // namespace openrt
