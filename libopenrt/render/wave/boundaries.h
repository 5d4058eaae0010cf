// boundaries.h: boundaries of media at hits, and the extinction of the media along rays. Path
// tracing and light tracing use the same. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

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
