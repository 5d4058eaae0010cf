// exact.h: a ray and a triangle in double precision, for what single precision cannot tell:
// triangles far longer than high, rays that graze them, and coordinates far larger than what is
// looked at. Pure functions. [any thread]
#pragma once

#include <cstdint>

#include "render/records.h"
#include "scene/matrix.h"

namespace openrt {

struct Meeting { // where a ray and a triangle meet: at origin + t direction = (1 - u - v) a + u b +
                 // v c
  double t = 0, u = 0, v = 0;
};

// Corners of a triangle relative to the ray's origin. Edge 0 is opposite to b (from a to c), edge 1
// to c, edge 2 to a.
struct SeenTriangle {
  Vec3d a, b, c;
};

// Whether the line along `direction` meets the triangle, its edges included. Two triangles with the
// same edge decide about it with the same number, so no ray passes between them.
bool meets(const SeenTriangle& triangle, const Vec3d& direction, Meeting& at);

// The point of the triangle that is next to the line along `direction`, which does not meet it.
// edges: a bit for each edge that counts, not 0. Returns the distance between the line and that
// point.
double nextTo(const SeenTriangle& triangle, const Vec3d& direction, unsigned edges, Meeting& at);

// Where the line meets the plane of the triangle; not finite if they are parallel.
double meetsPlane(const SeenTriangle& triangle, const Vec3d& direction);

// Whether the single precision of the ray kernels finds the triangle within an interval of the ray:
// Plucker coordinates as in Embree's robust mode. For counting where it is wrong.
bool foundInSingle(const SeenTriangle& triangle, const Vec3d& direction, float near, float far);

// A geometric normal of the kernel's frame in render space, of an instanced record.
inline void normalToRender(const Record& r, const float kernel[3], float out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = r.kernelNormal[i][0] * kernel[0] + r.kernelNormal[i][1] * kernel[1] +
             r.kernelNormal[i][2] * kernel[2];
}

// Whether single precision is wrong about where a ray meets a triangle: its t, u and v by more than
// 1e-5 or so of the triangle's distance. normal: across the triangle, of any length, in the frame
// of the direction; in floats, as it is asked of every hit.
inline bool grazes(const float normal[3], const float direction[3]) {
  float along = 0, n = 0, d = 0;
  for (int k = 0; k < 3; k++) {
    along += normal[k] * direction[k];
    n += normal[k] * normal[k];
    d += direction[k] * direction[k];
  }
  return !(along * along > 0x1p-12f * n * d); // also where these leave the range of floats
}

// Puts the hit of a ray of render space on triangle `primitive` of a record where the ray meets it
// in double precision, or next to it where it does not; t stays within the interval.
void settle(const Record& record, uint32_t primitive, const Vec3d& origin, const Vec3d& direction,
            float near, float far, float& t, float& u, float& v);

} // namespace openrt
