// face_set.h: polygons with attributes as IndexedFaceSet, ElevationGrid and Extrusion give them,
// and the way from there to a Mesh: face normals, creases, triangles, then vertices that carry one
// normal, colour and texture coordinate each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/faults.h"
#include "geometry/mesh.h"
#include "geometry/vector_math.h"

namespace xvrml {

inline constexpr uint32_t noValue = UINT32_MAX;

// Values given to the faces: none, one a point (values[point]), one a face (values[index[face]]),
// or one a corner (values[index[corner]]). An index may be noValue.
template <class T> struct Attribute {
  enum class Per : uint8_t { none, point, face, corner };
  Per per = Per::none;
  std::vector<uint32_t> index;
  std::span<const T> values;
  std::vector<T> own;

  // A copy of the values that can grow.
  std::vector<T>& grow() {
    if (own.empty() || values.data() != own.data()) own.assign(values.begin(), values.end());
    return own;
  }
  void push(const T& value) {
    grow().push_back(value);
    values = own;
  }
  uint32_t at(uint32_t corner, uint32_t face, uint32_t point) const {
    switch (per) {
    case Per::none: return noValue;
    case Per::point: return point < values.size() ? point : noValue;
    case Per::face: return index[face];
    default: return index[corner];
    }
  }
};

struct FaceSet {
  std::span<const Vec3f> points;
  std::vector<Vec3f> ownPoints;
  std::vector<uint32_t> corners; // a point a corner, face after face; every one below points.size()
  std::vector<uint32_t> faceStart; // first corner of each face, and the end
  std::vector<uint32_t> faceName;  // what to call a face in a warning (empty: its number)
  Attribute<Vec3f> normals;
  Attribute<Vec2f> texCoords;
  Attribute<Color> colors;
  bool solid = true, ccw = true;
  bool convex = true; // a promise that is checked
  uint32_t plainFaces =
      0; // the first so many faces are split without looking (strips of quadrilaterals)
  bool quietNoArea = false; // faces without area are no mistake of the author
  float creaseAngle = 0;    // radians; 0: flat

  std::vector<uint32_t> extraFaces; // faces of the corners that were added where edges cross
                                    // (behind faceStart.back())

  uint32_t faceCount() const { return faceStart.empty() ? 0 : uint32_t(faceStart.size() - 1); }
  uint32_t name(uint32_t face) const { return faceName.empty() ? face : faceName[face]; }
  std::vector<uint32_t> facesOfCorners() const;
};

// Everything from faces to the mesh. What is degenerate or not finite is dropped and counted in
// faults.
Mesh buildFaceMesh(FaceSet&& set, const MeshOptions& options, Faults& faults);

// The steps, each in its file.

// Unit normals by Newell's method; zero for a face that cannot be drawn (counted in faults).
std::vector<Vec3f> faceNormals(const FaceSet& set, Faults& faults);
// Normals of corners, smooth across edges between faces whose normals differ by less than
// creaseAngle.
void creaseNormals(FaceSet& set, std::span<const Vec3f> faceNormals);
// Given normals that are missing, zero or not finite become the face's own.
void repairNormals(FaceSet& set, std::span<const Vec3f> faceNormals, Faults& faults);
// Corner numbers, three a triangle; corners are added where a face crosses itself.
std::vector<uint32_t> triangulate(FaceSet& set, std::span<const Vec3f> faceNormals,
                                  const MeshOptions& options, Faults& faults);
// A vertex for every different (point, normal, colour, texture coordinate) that the triangles use.
Mesh weld(FaceSet&& set, std::span<const uint32_t> triangles);

// Corner numbers ordered by their point (stable).
std::vector<uint32_t> orderByPoint(std::span<const uint32_t> corners, size_t pointCount);

} // namespace xvrml
