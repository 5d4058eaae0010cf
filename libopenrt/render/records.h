// records.h: the data of each geometry from which a hit becomes a shading point. A backend makes
// the records when it builds a scene; they are immutable while a frame renders.
#pragma once

#include <array>
#include <cstdint>

#include "openrt/openrts.h"
#include "scene/scene.h"

namespace openrt {

// An affine map in float: row i maps p to r[i][0..2] . p + r[i][3].
struct Affine {
  float r[3][4];
  static Affine from(const Matrix4d& m) {
    Affine a;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) a.r[i][j] = float(m.m[4 * j + i]);
    return a;
  }
  Vec3f row(int i) const { return {r[i][0], r[i][1], r[i][2]}; }
  Vec3f column(int j) const { return {r[0][j], r[1][j], r[2][j]}; }
  Vec3f translation() const { return column(3); }

  // These compute in the type T of the argument's components. None of them normalises.

  // Returns the image of a direction: the linear part alone.
  template <class T> Vec3<T> direction(const Vec3<T>& v) const {
    return {dot(Vec3<T>(row(0)), v), dot(Vec3<T>(row(1)), v), dot(Vec3<T>(row(2)), v)};
  }
  // Returns the image of a point.
  template <class T> Vec3<T> point(const Vec3<T>& p) const {
    return direction(p) + Vec3<T>(translation());
  }
  // Like point(), but the sum starts with the translation, so its last digit may differ.
  template <class T> Vec3<T> pointFromTranslation(const Vec3<T>& p) const {
    return Vec3<T>(translation()) + Vec3<T>(column(0)) * p.x + Vec3<T>(column(1)) * p.y +
           Vec3<T>(column(2)) * p.z;
  }
  // Multiplies the transpose of the linear part by v. A map transforms normals by the transpose of
  // its inverse, so this maps a normal of the space that the map leads to back to the other space.
  template <class T> Vec3<T> transposed(const Vec3<T>& v) const {
    return {dot(Vec3<T>(column(0)), v), dot(Vec3<T>(column(1)), v), dot(Vec3<T>(column(2)), v)};
  }
  // Returns the image of a normal: the inverse transpose of the linear part. It computes the
  // inverse; where that is at hand, use inverse.transposed(n). Returns 0 0 0 for singular maps.
  template <class T> Vec3<T> normal(const Vec3<T>& n) const;
};

// Returns the sum of the squares of the linear part's numbers (the squared Frobenius norm).
inline double squaredNormOf(const Affine& m) {
  double sum = 0;
  for (const auto& row : m.r)
    for (int k = 0; k < 3; k++) sum += double(row[k]) * row[k];
  return sum;
}

// Returns the determinant of the linear part.
inline double determinantOf(const Affine& m) {
  return dot(Vec3d(m.row(0)), cross(Vec3d(m.row(1)), Vec3d(m.row(2))));
}

// Returns the inverse of an affine map, or the zero map if it is singular.
inline Affine inverseOf(const Affine& m) {
  const Vec3f a = m.row(0), b = m.row(1), c = m.row(2), bc = cross(b, c);
  const float determinant = dot(a, bc);
  Affine out{};
  if (determinant == 0) return out;
  const auto linear = Rows<float>::ofColumns(bc / determinant, cross(c, a) / determinant,
                                             cross(a, b) / determinant);
  const Vec3f translation = -(linear * m.translation());
  for (int i = 0; i < 3; i++) {
    store(linear[i], out.r[i]);
    out.r[i][3] = translation[i];
  }
  return out;
}

template <class T> Vec3<T> Affine::normal(const Vec3<T>& n) const {
  return inverseOf(*this).transposed(n);
}

// The frames of a geometry whose hits are not in render space: of an instance, a sphere or an
// analytic surface. Static triangles, of which large worlds mostly are, have none.
struct RecordFrames {
  // instanced: kernel's frame -> render space; sphere: unit-sphere frame -> render space; analytic
  // surface: its own frame -> render space
  Affine toRender;
  Affine fromRender;        // sphere and analytic surface: inverse of toRender
  Rows<float> kernelNormal; // instanced: the kernel's geometric normal -> render space
};

inline const RecordFrames noFrames{};

struct Record {
  edit::Primitive primitive = edit::Primitive::Triangles;
  // If true, the vertices are in the kernel's object frame, and frames->toRender maps them to
  // render space. Otherwise they are in render space divided by `scale`.
  bool instanced = false;
  bool cull = false;
  bool flip = false;   // the kernel's geometric normal points to the back
  uint32_t shader = 0; // index into ShaderTable
  // Index into the buckets (class, light set, fog); hits of a bucket are shaded together.
  uint32_t bucket = 0;
  uint32_t name = 0, instance = 0;
  uint32_t primitives = 0; // number of triangles, segments or points
  uint64_t userData = 0;
  const float* vertices = nullptr;   // stride 3, as the kernel sees them
  const uint32_t* indices = nullptr; // into vertices and attributes
  const float* normals = nullptr;    // stride 3, in the geometry's local frame
  const float* texCoords = nullptr;  // stride 2
  const float* colors = nullptr;     // stride 4
  const float* fogCoords = nullptr;  // share of the fog, stride 1
  // The geometry's own values of shader parameters, already validated.
  const GeometryParameter* parameters = nullptr;
  uint32_t parameterCount = 0;
  edit::TexGen texGen = edit::TexGen::Off;
  uint16_t pattern = Stipple::solid;
  const StippledLine* stippled = nullptr; // by line; null: they are solid
  float scale = 1;                        // not instanced: vertices times scale are in render space
  const RecordFrames* frames = &noFrames;
  const AnalyticSurface* surface = nullptr;
  // Normals of the geometry -> render space (inverse transpose), not normalised.
  Rows<float> normalMatrix;
  // Maps render space to the frame of the object that contains the geometry.
  const Affine* toObject = nullptr;

  // Returns whether there is a gap between dashes at a place of a line.
  bool isGap(uint32_t line, float u) const { return stippled[line].isGap(pattern, u); }
  // Returns corner 0, 1 or 2 of a triangle, as the kernel sees it.
  Vec3f corner(uint32_t triangle, int number) const {
    return vectorOf(vertices + 3 * size_t(indices[3 * size_t(triangle) + size_t(number)]));
  }
  // Maps a vertex that the kernel sees to render space.
  template <class T> Vec3<T> placeOf(const Vec3<T>& vertex) const {
    return instanced ? frames->toRender.point(vertex) : vertex * T(scale);
  }
  // Returns the corners of a triangle in render space.
  std::array<Vec3f, 3> cornersOf(uint32_t triangle) const {
    return {placeOf(corner(triangle, 0)), placeOf(corner(triangle, 1)),
            placeOf(corner(triangle, 2))};
  }
};

struct Bucket {
  const RtsClass* shaderClass = nullptr;
  uint32_t lightSet = 0;
  uint32_t fog = 0; // the environment shader whose fog lies in front of the hits; 0: the scene's
};

} // namespace openrt
