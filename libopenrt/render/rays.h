// rays.h: Defines batches of rays and hits, which the wavefront (render/) exchanges with the
// intersector (backend/local). They are structures of arrays in render space: the world's axes and
// units, origin at the camera.
#pragma once

#include <cstdint>

#include "render/arena.h"

namespace openrt {

inline constexpr uint32_t noHit = ~0u;

enum RayMask : uint32_t { // what a ray can hit
  maskOpaque = 1,
  maskTransparent = 2,
  maskThin = 4, // lines and points, which cast no shadows
  maskAll = 7
};

struct Rays {
  uint32_t count = 0; // the arrays have room for padded(count)
  float* org[3];
  float* dir[3];
  float* tnear;
  float* tfar;

  void allocate(Arena& arena, uint32_t capacity) {
    const uint32_t n = padded(capacity);
    for (auto& a : org) a = arena.take<float>(n);
    for (auto& a : dir) a = arena.take<float>(n);
    tnear = arena.take<float>(n);
    tfar = arena.take<float>(n);
    count = capacity;
  }
};

struct RayHits {
  float* t;
  float* u;
  float* v;
  float* ng[3];        // the kernel's geometric normal: not normalised, in the frame of the record
  uint32_t* record;    // index of the Record hit, or noHit
  uint32_t* primitive; // index of the primitive in the record's geometry

  void allocate(Arena& arena, uint32_t capacity) {
    const uint32_t n = padded(capacity);
    t = arena.take<float>(n);
    u = arena.take<float>(n);
    v = arena.take<float>(n);
    for (auto& a : ng) a = arena.take<float>(n);
    record = arena.take<uint32_t>(n);
    primitive = arena.take<uint32_t>(n);
  }
};

// coherent: rays of a regular pattern, such as those of a camera and to a lamp. They can be aimed
// exactly at vertices, where single precision loses hits; for them these hits are found, too.
// incoherent: rays of which only some are so aimed; Intersector::findLost() does it for those.
enum class Coherence : uint8_t { coherent, incoherent };

// Intersects rays with the scene. Thread-safe. An invalid ray (not finite, without a direction, or
// with an empty interval) hits nothing and is counted.
class Intersector {
 public:
  virtual ~Intersector() = default;
  virtual void intersect(const Rays& rays, uint32_t mask, Coherence coherence,
                         RayHits& hits) const = 0;
  // Searches for the hits that intersect() has lost at vertices. aimed: 1 for the rays to search
  // for. Rays that have a hit keep it.
  virtual void findLost(const Rays& rays, const uint8_t* aimed, RayHits& hits) const = 0;
  // Intersects rays with the scene as if culled back faces did not exist. It is slower than
  // intersect(), so it is called only for rays whose first hit is such a face.
  virtual void intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const = 0;
  // Finds the nearest hit of each ray that is not on the given record.
  virtual void intersectOthers(const Rays& rays, const uint32_t* record, RayHits& hits) const = 0;
  // Writes the bounds of the scene; low > high if it is empty. [any]
  virtual void bounds(float low[3], float high[3]) const = 0;
  // Sets blocked[i] to 1 if anything lies within the interval of ray i, else to 0.
  virtual void occluded(const Rays& rays, uint32_t mask, Coherence coherence,
                        uint8_t* blocked) const = 0;
  // Returns whether anything in the scene has culled back faces.
  virtual bool cullsBacks() const = 0;
  // Like occluded(), as if culled back faces did not exist. It is slower, so it is called only for
  // rays that occluded() finds blocked.
  virtual void occludedByFronts(const Rays& rays, uint32_t mask, uint8_t* blocked) const = 0;
};

} // namespace openrt
