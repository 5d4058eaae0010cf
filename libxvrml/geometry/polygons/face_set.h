// face_set.h: polygons with attributes, as given by IndexedFaceSet, ElevationGrid and Extrusion,
// and the steps from there to a Mesh: face normals, creases, triangles, then vertices with one
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

// Values given to the faces: none, one per point (values[point]), one per face
// (values[index[face]]) or one per corner (values[index[corner]]). An index may be noValue.
template <class T> struct Attribute {
  enum class Per : uint8_t { none, point, face, corner };
  Per per = Per::none;
  std::vector<uint32_t> index;
  std::span<const T> values;
  std::vector<T> own;

  // Returns a copy of the values that can grow.
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
  std::vector<uint32_t> corners;   // the point of each corner, face by face; always < points.size()
  std::vector<uint32_t> faceStart; // first corner of each face, then the total
  std::vector<uint32_t> faceName;  // the face's number in warnings; empty: its index
  Attribute<Vec3f> normals;
  Attribute<Vec2f> texCoords;
  Attribute<Color> colors;
  std::vector<float> alphas;    // as long as colors.values, or empty: opaque
  std::vector<Vec4f> texPlaces; // as long as texCoords.values, or empty: points on pictures
  std::vector<float> fogCoords; // as long as points, or empty
  bool solid = true, ccw = true;
  bool convex = true; // promised by the author; checked
  // This many leading faces are split without checks (strips of quadrilaterals).
  uint32_t uncheckedFaces = 0;
  bool ignoreNoArea = false;  // faces without area are not reported
  bool reportCrossed = false; // a face that crosses itself is reported
  float creaseAngle = 0;      // in radians; 0: flat

  // The faces of the corners added where edges cross (from faceStart.back() on).
  std::vector<uint32_t> extraFaces;

  uint32_t faceCount() const { return faceStart.empty() ? 0 : uint32_t(faceStart.size() - 1); }
  uint32_t name(uint32_t face) const { return faceName.empty() ? face : faceName[face]; }
  std::vector<uint32_t> facesOfCorners() const;

  // Sets the points. own: what `given` refers to, or empty if a node owns it.
  void takePoints(std::span<const Vec3f> given, std::vector<Vec3f>&& own) {
    ownPoints = std::move(own); // keeps its storage
    points = given;
  }
  // Sets the values of the texture coordinates. own: what `given` refers to, or empty if a node
  // owns it.
  void takeTexCoords(std::span<const Vec2f> given, std::vector<Vec2f>&& own,
                     std::vector<Vec4f>&& places) {
    texCoords.own = std::move(own); // keeps its storage
    texCoords.values = given;
    texPlaces = std::move(places);
  }
  // Sets the values of the colours. own: what `rgb` refers to, or empty if a node owns it.
  void takeColors(std::span<const Color> rgb, std::vector<Color>&& own,
                  std::vector<float>&& opacities) {
    colors.own = std::move(own); // keeps its storage
    colors.values = rgb;
    alphas = std::move(opacities);
  }
};

// Builds the mesh. Degenerate and non-finite parts are dropped and counted in faults.
Mesh buildFaceMesh(FaceSet&& set, const MeshOptions& options, Faults& faults);

// The steps, each in its own file.

// Returns unit face normals by Newell's method; zero for a face that cannot be drawn (counted in
// faults).
std::vector<Vec3f> faceNormals(const FaceSet& set, Faults& faults);
// Computes corner normals, smoothed across edges between faces whose normals differ by less than
// creaseAngle.
void creaseNormals(FaceSet& set, std::span<const Vec3f> faceNormals);
// Computes the same normals for triangles whose faces all smooth into each other, one for each
// point. Returns false if they do not, or a point is not used.
bool smoothNormals(std::span<const Vec3f> points, std::span<const uint32_t> triangles,
                   float creaseAngle, bool ccw, std::vector<Vec3f>& normals);
// Replaces missing, zero and non-finite normals by face normals.
void repairNormals(FaceSet& set, std::span<const Vec3f> faceNormals, Faults& faults);
// Returns three corner numbers per triangle. It adds corners where a face crosses itself.
std::vector<uint32_t> triangulate(FaceSet& set, std::span<const Vec3f> faceNormals,
                                  const MeshOptions& options, Faults& faults);
// Makes one vertex for each distinct (point, normal, colour, texture coordinate) that the triangles
// use.
Mesh weld(FaceSet&& set, std::span<const uint32_t> triangles);

// Returns the corner numbers sorted by point (stable).
std::vector<uint32_t> orderByPoint(std::span<const uint32_t> corners, size_t pointCount);

} // namespace xvrml
