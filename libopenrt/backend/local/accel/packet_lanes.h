// packet_lanes.h: copies rays into Embree's packets and hits out of them, with vector lanes. Called
// by render threads and the threads of queries.
#pragma once

#include <cstdint>

#include "render/rays.h"

namespace openrt {

// The arrays of an RTCRay8 or RTCRay16.
struct PacketRays {
  float *org[3], *dir[3], *tnear, *tfar;
  uint32_t *mask, *id, *flags;
  float* time;
};
// The arrays of its hits.
struct PacketHits {
  const float *tfar, *u, *v, *ng[3];
  const uint32_t* geometry;
};

// Fills a packet of `size` rays with those from number `first` on, in the units of the kernel.
// Writes -1 to `valid` for each ray that is there and can be traced, else 0; such rays get harmless
// values. ends: tfar of these rays. limit: the largest coordinate of an origin in the units of the
// kernel, and of a direction. Returns how many rays were rejected.
uint32_t loadPacket(const Rays& rays, const float* ends, uint32_t first, uint32_t size, float scale,
                    float limit, uint32_t mask, int* valid, const PacketRays& to);

struct PacketMet { // bits by ray of the packet
  uint32_t hit;    // valid rays that hit something
  // Hits at a grazing angle, if the kernel's normal is in the frame of the ray (ray_triangle.h).
  uint32_t grazing;
};
// Copies t, u, v and the normal of all rays of a packet into `hits` from number `first` on. t is
// infinite for those without a hit.
PacketMet storePacket(const PacketHits& packet, const Rays& rays, const int* valid, uint32_t first,
                      uint32_t size, float unscale, const RayHits& hits);

} // namespace openrt
