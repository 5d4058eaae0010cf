// accel_leaks.cpp: finds what Embree lost at vertices. Its robust mode is watertight along edges,
// but where a ray passes exactly through a vertex, the rounded tests of all triangles around it may
// fail (decision 54). Random rays hardly ever do; rays of a regular grid aimed at regular geometry
// do. Called by render threads.
//
// Rays that may have passed a surface in this way are traced again with a direction turned by
// 2^-19, which is more than the tests err by. If the turned ray hits a triangle at a corner that
// the given ray passes within rounding, the given ray hits that triangle.
#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/local/accel/accel.h"
#include "backend/local/ray_triangle.h"

namespace openrt {
namespace {

constexpr float turn = 0x1p-19f;

// Returns a direction turned by about 2^-19 towards no edge of a mesh that is aligned with an axis.
Vec3f turned(const Vec3f& d) {
  const Vec3f size = abs(d);
  const Vec3f axis = size.x <= size.y && size.x <= size.z ? Vec3f{1, 0, 0}
                     : size.y <= size.z                   ? Vec3f{0, 1, 0}
                                                          : Vec3f{0, 0, 1};
  const Vec3f p = cross(d, axis), q = cross(d / largest(size), p);
  return d + (p + q * 0.375f) * turn;
}

// Returns whether a ray passes a corner of a triangle as closely as rounding can move it.
bool isAtCorner(const Record& r, uint32_t primitive, const Vec3f& origin, const Vec3f& direction) {
  const Vec3d o(origin), d(direction);
  const double square = dot(d, d);
  for (int k = 0; k < 3; k++) {
    const Vec3d corner = r.placeOf(Vec3d(r.corner(primitive, k))), to = corner - o;
    const double distance = length(to - d * (dot(to, d) / square)),
                 rounding = 0x1p-20 * length(to) + 0x1p-22 * (length(corner) + length(o));
    if (distance <= rounding) return true;
  }
  return false;
}

// Rays to be traced again, in packets.
struct Again {
  static constexpr uint32_t room = 64;
  alignas(64) float org[3][room], dir[3][room], near[room], far[room];
  alignas(64) float t[room], u[room], v[room], ng[3][room];
  uint32_t record[room], primitive[room];
  uint32_t lane[room];
  uint32_t count = 0;

  void add(const Rays& from, uint32_t i) {
    store(load(from.org, i), org, count);
    store(turned(load(from.dir, i)), dir, count);
    near[count] = from.tnear[i];
    far[count] = from.tfar[i];
    lane[count++] = i;
  }
  Rays rays() { return {count, {org[0], org[1], org[2]}, {dir[0], dir[1], dir[2]}, near, far}; }
  RayHits hits() { return {t, u, v, {ng[0], ng[1], ng[2]}, record, primitive}; }
};

} // namespace

void Accel::measure() {
  float low[3], high[3];
  bounds(low, high);
  low_ = vectorOf(low);
  high_ = vectorOf(high);
  const float margin =
      0x1p-20f * (largest(high_ - low_) + std::max(largest(abs(low_)), largest(abs(high_))));
  low_ = low_ - Vec3f{margin, margin, margin};
  high_ = high_ + Vec3f{margin, margin, margin};
}

// An endless ray from outside of the scene's bounds that hits nothing has left nothing. Only rays
// that can be traced are traced again, so that others are counted once.
bool Accel::mayHaveLeaked(const Rays& rays, uint32_t i) const {
  constexpr float most = std::numeric_limits<float>::max();
  const Vec3f o = load(rays.org, i), d = load(rays.dir, i);
  const bool inside = o.x >= low_.x && o.y >= low_.y && o.z >= low_.z && o.x <= high_.x &&
                      o.y <= high_.y && o.z <= high_.z;
  if (!inside && !(rays.tfar[i] <= most && largest(abs(o)) * scale_ <= 1e18f)) return false;
  const float size = dot(abs(d), {1, 1, 1});
  return size > 0 && size < 1e17f && rays.tnear[i] >= 0 && rays.tnear[i] <= rays.tfar[i];
}

// Calls found(lane, hits, i) for every ray for which isOpen(lane) holds and that hits a triangle at
// a corner. i: the place of the hit in `hits`.
template <class Open, class Found> void Accel::searchLost(const Rays& rays, const Open& isOpen,
                                                          const Trace& trace,
                                                          const Found& found) const {
  Again again;
  const auto flush = [&] {
    const Rays turnedRays = again.rays();
    RayHits hits = again.hits();
    trace(turnedRays, hits);
    for (uint32_t i = 0; i < again.count; i++) {
      if (hits.record[i] == noHit) continue;
      const Record& r = records[hits.record[i]];
      const uint32_t lane = again.lane[i];
      if (r.primitive == edit::Primitive::Triangles &&
          isAtCorner(r, hits.primitive[i], load(rays.org, lane), load(rays.dir, lane)))
        found(lane, hits, i);
    }
    again.count = 0;
  };
  for (uint32_t i = 0; i < rays.count; i++) {
    if (!isOpen(i) || !mayHaveLeaked(rays, i)) continue;
    again.add(rays, i);
    if (again.count == Again::room) flush();
  }
  if (again.count) flush();
}

void Accel::findLostHits(const Rays& rays, const uint8_t* aimed, const Trace& trace,
                         RayHits& hits) const {
  searchLost(
      rays, [&](uint32_t i) { return hits.record[i] == noHit && (!aimed || aimed[i]); }, trace,
      [&](uint32_t lane, const RayHits& lost, uint32_t i) {
        const RaySegment ray{Vec3d(load(rays.org, lane)), Vec3d(load(rays.dir, lane)),
                             rays.tnear[lane], rays.tfar[lane]};
        const auto at = refineHit(records[lost.record[i]], lost.primitive[i], ray);
        if (!at) return;
        hits.t[lane] = float(at->t);
        hits.u[lane] = float(at->u);
        hits.v[lane] = float(at->v);
        store(load(lost.ng, i), hits.ng, lane);
        hits.record[lane] = lost.record[i];
        hits.primitive[lane] = lost.primitive[i];
      });
}

void Accel::findLost(const Rays& rays, const uint8_t* aimed, RayHits& hits) const {
  findLostHits(
      rays, aimed,
      [&](const Rays& again, RayHits& found) {
        intersectInSinglePrecision(again, maskAll, Coherence::incoherent, found);
      },
      hits);
}

void Accel::findLostBlockers(const Rays& rays, const Trace& trace, uint8_t* blocked) const {
  searchLost(
      rays, [&](uint32_t i) { return !blocked[i]; }, trace,
      [&](uint32_t lane, const RayHits&, uint32_t) { blocked[lane] = 1; });
}

} // namespace openrt
