// sliver_lanes.h: rejects rays that clearly miss a sliver, for whole packets, in single precision.
// The doubles of slivers.cpp decide about the others. Called by render threads and the threads of
// queries.
#pragma once

#include <cstdint>

#include "scene/matrix.h"

namespace openrt {

// A triangle in Pluecker coordinates about its middle, rounded to float.
struct SliverOutline {
  float center[3];
  float edge[3][3], moment[3][3]; // c - a, a - b, b - c, and their cross products with the sums of
                                  // their end points
  float extent;                   // the largest coordinate of a corner
  // The tolerance of mayHit() without the factors of the ray. It is infinite for a triangle so
  // large or small that products may leave the range of floats.
  float doubt;

  SliverOutline(const Vec3d& a, const Vec3d& b, const Vec3d& c);
};

// The arrays of a packet of 1, 4, 8 or 16 rays. valid: -1 for the rays that are traced.
struct PacketLines {
  const float *origin[3], *direction[3];
  const int* valid;
  uint32_t size;
};

// Returns a bit for each valid ray whose line may pass the triangle so closely that the rounding of
// floats, or the tolerance of slivers.cpp at open edges, makes it a hit.
uint32_t mayHit(const SliverOutline& sliver, const PacketLines& rays);

} // namespace openrt
