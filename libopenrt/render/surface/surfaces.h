// surfaces.h: processing of hits before shading: culled back faces and boundaries of media. Used by
// the path tracer and the light tracer. [render]
#pragma once

#include "render/surface/batch.h"
#include "render/surface/media.h"

namespace openrt {

// Copies the rays of the given lanes.
Rays copyRays(const Rays& rays, const uint32_t* rayLanes, uint32_t n, Arena& arena);

// Retraces the rays whose nearest hit is a culled back face with such faces ignored. The rays are
// traced again from their origins, because a front and a back face in the same place must not hide
// each other.
void skipCulledBacks(const RenderScene& scene, Arena& arena, RayCounters& counters,
                     const Rays& rays, RayHits& hits);
// Finds the nearest hit of each ray, as if culled back faces did not exist. The hits lie in the
// arena. aimed: which of incoherent rays may be aimed at vertices (Intersector::findLost); or null.
RayHits findNearest(const StageContext& context, const Rays& rays, Coherence coherence,
                    const uint8_t* aimed = nullptr);
// Returns whether rays from the eye in all directions seldom leave the scene.
bool isEnclosed(const RenderScene& scene);
// Sets blocked[i] to 1 if anything but a culled back face lies within the interval of ray i, else
// to 0. Transparent surfaces, lines and points block as well.
void findBlocked(const RenderScene& scene, const Rays& rays, uint8_t* blocked);

// Boundaries of media at the hits of a batch, by hit. Null: there are none.
struct Boundaries {
  Crossing* crossing = nullptr;
  float (*eta)[3] = nullptr; // relative index of refraction by colour: ray's side over far side
  // 1 where the ray carries several colours that are refracted differently; null: nowhere.
  uint32_t* disperses = nullptr;

  // Returns false where a boundary has no effect on light, because another medium wins there.
  bool visibleAt(uint32_t i) const { return !crossing || crossing[i].visible; }
  const float* etaAt(uint32_t i) const { return eta ? eta[i] : nullptr; }
};
// Computes the media on both sides of each hit if the class has a medium. Called after its
// `surface`. Sets all weights to 0 at boundaries that have no effect: inside a medium of higher
// priority, and of RTS_MEDIUM_ONLY between equal indices. Sets the index of dielectric lobes to
// that of the colour that a ray carries.
Boundaries crossBoundaries(RtsBatch& batch, const RtsClass& shaderClass);

// Returns the media on the side of hit i that a direction leads to. media: on the ray's side.
inline const MediaStack& mediaTowards(const Points& points, uint32_t i, const Vec3f& direction,
                                      const Crossing* crossing, const MediaStack& media) {
  const bool behind = dot(load(points.hits.geometric, i), direction) < 0;
  return behind && crossing ? crossing[i].behind : media;
}
inline const MediaStack& mediaTowards(const Points& points, uint32_t i, const Vec3f& direction,
                                      const Boundaries& boundaries, const MediaStack& media) {
  return mediaTowards(points, i, direction, boundaries.crossing, media);
}

// Attenuates the rays' throughput by the extinction of the media between origin and hit, without
// the media in which rays collide (medium/flights.h).
void absorbAlongRays(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                     const PathStates& states);

} // namespace openrt
