// point_block.h: 16 hits on their way to shading points. points.cpp gathers what the records say
// into a block; the functions below compute with vector lanes (point_block.cpp). [render]
#pragma once

#include "openrt/openrts.h"
#include "render/arena.h"

namespace openrt {

// Attributes that at least one hit of a block has. Only these arrays of the block are filled.
enum PointAttributes : uint32_t {
  pointInstanced = 1,
  pointNormals = 2,
  pointTexCoords = 4,
  pointColors = 8
};

// Arrays are indexed by [corner][component][hit] and [row][column][hit].
struct alignas(64) PointBlock {
  uint32_t attributes;       // what any hit has (PointAttributes)
  uint32_t own[lanes];       // by hit (PointAttributes)
  float direction[3][lanes]; // the direction of the ray
  float ng[3][lanes];        // the kernel's geometric normal; after interpolation in render space
  uint32_t flipped[lanes];   // ~0: the geometric normal points to the back, else 0
  uint32_t flags[lanes];     // RTS_HIT_*
  // Triangles: corners and barycentric coordinates of the hit.
  float corner[3][3][lanes];
  float u[lanes], v[lanes];
  float scale[lanes];                // Record::scale
  float toRender[3][4][lanes];       // pointInstanced
  float kernelNormal[3][3][lanes];   // pointInstanced
  float cornerNormal[3][3][lanes];   // pointNormals
  float normalMatrix[3][3][lanes];   // pointNormals
  float cornerTexCoord[3][2][lanes]; // pointTexCoords
  float cornerColor[3][4][lanes];    // pointColors
  // Results of interpolation: position and its error bound in render space, normal of the vertices.
  float position[3][lanes], bound[3][lanes], normal[3][lanes];
  uint32_t smooth[lanes]; // ~0: `normal` is valid, else 0
  float uv[2][lanes], color[4][lanes];
};

struct PointArrays { // the arrays of shading points that blocks are written to
  float *position[3], *direction[3], *geometric[3], *normal[3], *uv[2], *color[4], *distance,
      *segment, *error;
  uint32_t *flags, *record;
  const void** params;
};

// Interpolates all hits of the block as triangles.
void interpolateTriangles(PointBlock& block);
// Computes normals, flags and error of all hits, and writes them to elements i to i + 15.
void finishPoints(const PointBlock& block, const PointArrays& out, uint32_t i);

// Relative error bound of n rounded operations: gamma(n) = n e / (1 - n e), e = 2^-24 (pbrt).
constexpr float gammaOf(int n) { return n * 0x1p-24f / (1 - n * 0x1p-24f); }

} // namespace openrt
