// rays.h: batches of rays between the wavefront (render/) and whoever intersects them
// (backend/local). Structures of arrays in render space: the world's axes and units, origin at the
// camera.
#pragma once

#include <cstdint>

#include "render/arena.h"

namespace openrt {

inline constexpr uint32_t noHit = ~0u;

enum RayMask : uint32_t { // what a ray may meet
  maskOpaque = 1,
  maskTransparent = 2,
  maskThin = 4, // lines and points, which cast no shadows
  maskAll = 7
};

struct Rays {
  uint32_t count = 0; // arrays have room for padded(count)
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
  float* ng[3];     // geometric normal as the kernel gives it: not unit, in the frame of the record
  uint32_t* record; // index of the Record hit, or noHit
  uint32_t* primitive; // in the record's geometry

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

enum class Coherence : uint8_t { coherent, incoherent };

// Thread-safe. A ray that is not finite, has no direction or an interval that is no interval hits
// nothing and is counted.
class Intersector {
 public:
  virtual ~Intersector() = default;
  virtual void intersect(const Rays& rays, uint32_t mask, Coherence coherence,
                         RayHits& hits) const = 0;
  // The same, but the backs of culled surfaces are not there. Slower: for the rays whose first hit
  // is such a back.
  virtual void intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const = 0;
  // Nearest hits on other records than one for each ray.
  virtual void intersectOthers(const Rays& rays, const uint32_t* record, RayHits& hits) const = 0;
  // Of all there is; low > high where nothing is. [any]
  virtual void bounds(float low[3], float high[3]) const = 0;
  // 1 where something lies within the ray's interval.
  virtual void occluded(const Rays& rays, uint32_t mask, Coherence coherence,
                        uint8_t* blocked) const = 0;
};

} // namespace openrt
