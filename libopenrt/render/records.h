// records.h: the data of each geometry from which a hit becomes a shading point. A backend makes
// the records when it builds a scene; they are immutable while a frame renders.
#pragma once

#include <cstdint>

#include "openrt/openrts.h"
#include "scene/scene.h"

namespace openrt {

struct Affine { // 3x4: x' = r[0][0..2] . p + r[0][3]
  float r[3][4];
  static Affine from(const Matrix4d& m) {
    Affine a;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) a.r[i][j] = float(m.m[4 * j + i]);
    return a;
  }
};

// Returns the determinant of the linear part.
inline double determinantOf(const Affine& map) {
  const auto& m = map.r;
  return m[0][0] * (double(m[1][1]) * m[2][2] - double(m[1][2]) * m[2][1]) -
         m[0][1] * (double(m[1][0]) * m[2][2] - double(m[1][2]) * m[2][0]) +
         m[0][2] * (double(m[1][0]) * m[2][1] - double(m[1][1]) * m[2][0]);
}

// Returns the inverse of an affine map, or the zero map if it is singular.
inline Affine inverseOf(const Affine& m) {
  const auto& r = m.r;
  const float c[3][3] = {
      {r[1][1] * r[2][2] - r[1][2] * r[2][1], r[0][2] * r[2][1] - r[0][1] * r[2][2],
       r[0][1] * r[1][2] - r[0][2] * r[1][1]},
      {r[1][2] * r[2][0] - r[1][0] * r[2][2], r[0][0] * r[2][2] - r[0][2] * r[2][0],
       r[0][2] * r[1][0] - r[0][0] * r[1][2]},
      {r[1][0] * r[2][1] - r[1][1] * r[2][0], r[0][1] * r[2][0] - r[0][0] * r[2][1],
       r[0][0] * r[1][1] - r[0][1] * r[1][0]}};
  const float determinant = r[0][0] * c[0][0] + r[0][1] * c[1][0] + r[0][2] * c[2][0];
  Affine out{};
  if (determinant == 0) return out;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out.r[i][j] = c[i][j] / determinant;
    out.r[i][3] = -(out.r[i][0] * r[0][3] + out.r[i][1] * r[1][3] + out.r[i][2] * r[2][3]);
  }
  return out;
}

struct Record {
  edit::Primitive primitive = edit::Primitive::Triangles;
  // If true, the vertices are in the kernel's object frame, and `toRender` maps them to render
  // space. Otherwise they are in render space divided by `scale`.
  bool instanced = false;
  bool cull = false;
  bool flip = false;   // the kernel's geometric normal points to the back
  uint32_t shader = 0; // index into ShaderTable
  // Index into the buckets (class, light set); hits of a bucket are shaded together.
  uint32_t bucket = 0;
  uint32_t name = 0, instance = 0;
  uint32_t primitives = 0; // number of triangles, segments or points
  uint64_t userData = 0;
  const float* vertices = nullptr;   // stride 3, as the kernel sees them
  const uint32_t* indices = nullptr; // into vertices and attributes
  const float* normals = nullptr;    // stride 3, in the geometry's local frame
  const float* texCoords = nullptr;  // stride 2
  const float* colors = nullptr;     // stride 4
  // The geometry's own values of shader parameters, already validated.
  const GeometryParameter* parameters = nullptr;
  uint32_t parameterCount = 0;
  float scale = 1; // not instanced: vertices times scale are in render space
  // instanced: kernel's frame -> render space; sphere: unit-sphere frame -> render space
  Affine toRender;
  Affine fromRender; // sphere: inverse of toRender
  // Normals of the geometry -> render space (inverse transpose), not normalised.
  float normalMatrix[3][3];
  Affine toObject;          // render space -> frame of the object that contains the geometry
  float kernelNormal[3][3]; // instanced: the kernel's geometric normal -> render space
};

struct Bucket {
  const RtsClass* shaderClass = nullptr;
  uint32_t lightSet = 0;
};

} // namespace openrt
