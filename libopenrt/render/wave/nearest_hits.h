// nearest_hits.h: what rays hit first, and whether anything blocks them, as if culled back faces
// did not exist. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

// Copies the rays of the given lanes.
Rays copyRays(const Rays& rays, const uint32_t* rayLanes, uint32_t n, Arena& arena);

// Retraces the rays whose nearest hit is a culled back face with such faces ignored. The rays are
// traced again from their origins, because a front and a back face in the same place must not hide
// each other. skipped: gets 1 for these rays; or null.
void skipCulledBacks(const RenderScene& scene, Arena& arena, RayCounters& counters,
                     const Rays& rays, RayHits& hits, uint8_t* skipped = nullptr);
// Finds the nearest hit of each ray, as if culled back faces did not exist. The hits lie in the
// arena. aimed: which of incoherent rays may be aimed at vertices (Intersector::findLost); or null.
// skipped: as for skipCulledBacks().
RayHits findNearest(const StageContext& context, const Rays& rays, Coherence coherence,
                    const uint8_t* aimed = nullptr, uint8_t* skipped = nullptr);
// Returns whether rays from the eye in all directions seldom leave the scene.
bool isEnclosed(const RenderScene& scene);
// Sets blocked[i] to 1 if anything but a culled back face lies within the interval of ray i, else
// to 0. Transparent surfaces, lines and points block as well.
void findBlocked(const RenderScene& scene, const Rays& rays, uint8_t* blocked);

} // namespace openrt
