// cube_lookup.h: where pictures of all directions are met: six faces of a cube, or one picture of
// the whole sphere. Used by the environment and by cube maps of surfaces. [render]
#pragma once

#include <cstdint>

#include "vrml97/batch.h"

namespace vrml97 {

struct FaceCoords {
  uint32_t face; // front, back, left, right, top, bottom
  float s, t;
};

// Returns the face of a cube in a direction, and the texture coordinates there. Seen from inside,
// each picture is upright after turning from the front by 90 degrees left, right, up or down.
inline FaceCoords faceCoordsOf(float x, float y, float z) {
  const float ax = larger(x, -x), ay = larger(y, -y), az = larger(z, -z);
  const auto place = [](uint32_t face, float right, float up, float depth) {
    const float scale = 0.5f / larger(depth, 1e-37f);
    return FaceCoords{face, 0.5f + right * scale, 0.5f + up * scale};
  };
  if (az >= ax && az >= ay) return z <= 0 ? place(0, x, y, az) : place(1, -x, y, az);
  if (ax >= ay) return x <= 0 ? place(2, -z, y, ax) : place(3, z, y, ax);
  return y >= 0 ? place(4, x, z, ay) : place(5, x, -z, ay);
}

// Writes the places of n directions, whole vectors of lanes, in a picture of all longitudes and
// latitudes with its middle along -z.
void mapPlaces(uint32_t n, const float* x, const float* y, const float* z, float* u, float* v);

} // namespace vrml97
