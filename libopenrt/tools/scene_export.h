// scene_export.h: exports the scene of a recording for other programs (openrt-replay --export).
// [main thread]
#pragma once

#include <string>

#include "scene/scene.h"
#include "shading/registry.h"

namespace openrt {

// Writes PATH (JSON) and PATH.bin (arrays, little-endian). The JSON has
//   frame        width, height, samples, depth
//   shaders      by id: class, library, kind, parameters by name (defaults where nothing was set)
//   meshes       every placed geometry: kind (triangles, sphere, lines, points), shader, matrix
//                to the world (column-major), cull, clockwise, radius; points, indices, normals,
//                texCoords, colors, fogCoords: {offset, count} in PATH.bin, floats or uint32.
//                offset: in bytes, a multiple of 4; count: number of values
//   lights, camera, environment    shader and matrix
//   textures     by id: width, height, depth, components, float, srgb, texels {offset, count}:
//                floats if `float`, else bytes; rows from the bottom up, slice by slice
// Per-vertex parameters are not exported. Throws std::runtime_error.
void exportScene(const Scene& scene, const ShaderRegistry& shaders, const std::string& path);

} // namespace openrt
