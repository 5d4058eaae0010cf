// primitives.h: converts the vertex modes of OpenGL to triangles, segments and points, and drops
// degenerate ones. Pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "api/errors.h"
#include "degenerate.h"
#include "edits_generated.h"

namespace openrt {

inline edit::Primitive primitiveOf(RTenum mode) {
  switch (mode) {
  case RT_POINTS: return edit::Primitive::Points;
  case RT_LINES:
  case RT_LINE_STRIP: return edit::Primitive::Lines;
  case RT_TRIANGLES:
  case RT_TRIANGLE_STRIP:
  case RT_TRIANGLE_FAN:
  case RT_QUADS:
  case RT_QUAD_STRIP:
  case RT_POLYGON: return edit::Primitive::Triangles;
  default: fail(RT_INVALID_ENUM, "unknown mode " + std::to_string(mode));
  }
}

// Returns the largest number of indices for `count` vertices of a mode. Vertices that do not
// complete a primitive are ignored, as in OpenGL.
inline size_t indexCount(RTenum mode, size_t count) {
  switch (mode) {
  case RT_POINTS: return count;
  case RT_LINES: return count / 2 * 2;
  case RT_LINE_STRIP: return count < 2 ? 0 : 2 * (count - 1);
  case RT_TRIANGLES: return count / 3 * 3;
  case RT_QUADS: return count / 4 * 6;
  case RT_QUAD_STRIP: return count < 4 ? 0 : (count / 2 - 1) * 6;
  default: return count < 3 ? 0 : 3 * (count - 2); // strips, fans, polygons
  }
}

inline bool samePoint(const float* a, const float* b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// Returns the vertex (of `count`) that completes primitive number `ordinal`. Its parameter value
// applies to the whole primitive (OpenGL's provoking vertex).
inline size_t completingVertex(RTenum mode, size_t count, size_t ordinal) {
  switch (mode) {
  case RT_POINTS: return ordinal;
  case RT_LINES: return 2 * ordinal + 1;
  case RT_LINE_STRIP: return ordinal + 1;
  case RT_TRIANGLES: return 3 * ordinal + 2;
  case RT_QUADS: return ordinal / 2 * 4 + 3;
  case RT_QUAD_STRIP: return ordinal / 2 * 2 + 3;
  case RT_POLYGON: return count - 1;
  default: return ordinal + 2; // strips, fans
  }
}

// Writes the indices of the primitives of `count` vertices of a mode and returns the end of the
// written indices. Degenerate primitives are left out and counted.
//   vertexOf(i)    returns the index of the i-th vertex in points
//   out            has room for indexCount(mode, count) indices
//   kept(ordinal)  is called for every primitive that is written, with its number among all
template <class VertexOf, class Kept>
uint32_t* writeIndices(RTenum mode, size_t count, const float* points, const VertexOf& vertexOf,
                       uint32_t* out, uint64_t& degenerate, const Kept& kept) {
  size_t ordinal = 0;
  const auto triangle = [&](size_t i, size_t j, size_t k) {
    const uint32_t a = vertexOf(i), b = vertexOf(j), c = vertexOf(k);
    const size_t number = ordinal++;
    if (degenerateTriangle(points + 3 * size_t(a), points + 3 * size_t(b),
                           points + 3 * size_t(c))) {
      degenerate++;
      return;
    }
    out[0] = a;
    out[1] = b;
    out[2] = c;
    out += 3;
    kept(number);
  };
  const auto segment = [&](size_t i, size_t j) {
    const uint32_t a = vertexOf(i), b = vertexOf(j);
    const size_t number = ordinal++;
    if (samePoint(points + 3 * size_t(a), points + 3 * size_t(b))) {
      degenerate++;
      return;
    }
    out[0] = a;
    out[1] = b;
    out += 2;
    kept(number);
  };
  switch (mode) {
  case RT_POINTS:
    for (size_t i = 0; i < count; i++) *out++ = vertexOf(i), kept(i);
    break;
  case RT_LINES:
    for (size_t i = 0; i + 1 < count; i += 2) segment(i, i + 1);
    break;
  case RT_LINE_STRIP:
    for (size_t i = 0; i + 1 < count; i++) segment(i, i + 1);
    break;
  case RT_TRIANGLES:
    for (size_t i = 0; i + 2 < count; i += 3) triangle(i, i + 1, i + 2);
    break;
  case RT_TRIANGLE_STRIP: // every second triangle is reversed, so that all have the same winding
    for (size_t i = 0; i + 2 < count; i++) triangle(i + (i & 1), i + 1 - (i & 1), i + 2);
    break;
  case RT_TRIANGLE_FAN:
  case RT_POLYGON:
    for (size_t i = 1; i + 1 < count; i++) triangle(0, i, i + 1);
    break;
  case RT_QUADS:
    for (size_t i = 0; i + 3 < count; i += 4) {
      triangle(i, i + 1, i + 2);
      triangle(i, i + 2, i + 3);
    }
    break;
  case RT_QUAD_STRIP: // the quad is 0 1 3 2
    for (size_t i = 0; i + 3 < count; i += 2) {
      triangle(i, i + 1, i + 3);
      triangle(i, i + 3, i + 2);
    }
    break;
  default: break;
  }
  return out;
}

template <class VertexOf> uint32_t* writeIndices(RTenum mode, size_t count, const float* points,
                                                 const VertexOf& vertexOf, uint32_t* out,
                                                 uint64_t& degenerate) {
  return writeIndices(mode, count, points, vertexOf, out, degenerate, [](size_t) {});
}

} // namespace openrt
