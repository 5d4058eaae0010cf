// points.h: turns ray hits into shading points, sorted into buckets of one shader class, one
// light set and one fog. [render]
#pragma once

#include <bit>
#include <span>

#include "render/render_scene.h"

namespace openrt {

struct BucketRange {
  uint32_t bucket, begin, end; // positions in the sorted order
};

// Shading points of one bucket, with additional data for the host.
struct Points {
  RtsHits hits;
  float* error;           // bound of the position's rounding error along the geometric normal
  const uint32_t* record; // index of the Record of each point
  const RayHits* rayHits; // the ray hits that the points were made from
  const uint32_t* order;  // lane of each point in rayHits
};

// Sorts n ray lanes by the bucket of the record each has hit (stable counting sort). `order` gets
// the lanes. Returns the ranges of the buckets that are not empty; they lie in the arena.
std::span<const BucketRange> sortByBucket(const RenderScene& scene, const RayHits& hits,
                                          const uint32_t* rayLanes, uint32_t n, uint32_t* order,
                                          Arena& arena);

// Computes the shading points of n hits. travelled: path length up to the ray's origin, by ray
// lane.
Points makePoints(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                  const uint32_t* order, uint32_t n, const float* travelled, Arena& arena);

// Returns whether the ray has hit the back face of a surface.
inline bool isBackFaceHit(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                          uint32_t lane) {
  const Record& r = scene.records[hits.record[lane]];
  const Vec3f kernel = load(hits.ng, lane),
              n = r.instanced ? r.frames->kernelNormal * kernel : kernel;
  const float d = dot(n, load(rays.dir, lane));
  return r.flip ? d < 0 : d > 0;
}
// Returns whether the hit is a back face that is culled, or in a gap of a dashed line.
inline bool isCulledHit(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                        uint32_t lane) {
  const Record& r = scene.records[hits.record[lane]];
  return r.cull && (isBackFaceHit(scene, rays, hits, lane) ||
                    (r.stippled && r.isGap(hits.primitive[lane], hits.u[lane])));
}

// Lifts the point of hit i from its flat triangle to the smooth surface that the vertex normals
// describe, on the side of the shading normal: J. Hanika, "Hacking the Shadow Terminator", Ray
// Tracing Gems II, ch. 4. Returns false and writes nothing if the surface is flat.
bool liftToSmooth(const RenderScene& scene, const Points& points, uint32_t i, Vec3f& out);

// Returns the fog coordinate of hit i, or a negative number if its geometry has none.
float fogCoordAt(const RenderScene& scene, const Points& points, uint32_t i);

// Moves p along the unit vector n out of the error bound, then by one more float on every axis: M.
// Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., 3.9.5.
inline Vec3f offsetPoint(const Vec3f& p, const Vec3f& n, float error) {
  const auto along = [](float place, float step) {
    const float moved = place + step;
    const int32_t bits = std::bit_cast<int32_t>(moved);
    // The next float is away from zero or towards it.
    const int32_t outward = (step > 0) == (moved > 0) ? bits + 1 : bits - 1;
    const float next = moved != 0 ? std::bit_cast<float>(outward) : step;
    return step != 0 ? next : moved;
  };
  return {along(p.x, n.x * error), along(p.y, n.y * error), along(p.z, n.z * error)};
}

// Moves the point of hit i off its surface, to the side that a direction leads to.
inline Vec3f liftPoint(const Points& points, uint32_t i, const Vec3f& direction) {
  const Vec3f p = load(points.hits.position, i), n = load(points.hits.geometric, i);
  return offsetPoint(p, dot(n, direction) > 0 ? n : -n, points.error[i]);
}

} // namespace openrt
