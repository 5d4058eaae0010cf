// large_mesh.h: The arrays of a shape for the z-buffer. Large meshes of triangles are taken from
// their node as they are: making normals and texture coordinates for them takes longer than to
// draw them. [the thread that owns the world]
#pragma once

#include "xvrml/renderer.h"

namespace picture::raster {

// Indices of an IndexedFaceSet from which on it is large: those of 100,000 triangles.
inline constexpr size_t largeMesh = 400'000;

// Returns the arrays of a shape. A large IndexedFaceSet of triangles is shaded flat, if it has a
// plain material and neither colours nor normals of its own.
xvrml::GeometryArrays arraysOf(const xvrml::DrawnShape& shape);

} // namespace picture::raster
