// surfaces2d.cpp: the surfaces of X3D in the plane z = 0, whose front faces +z: ArcClose2D, Disk2D,
// Rectangle2D and TriangleSet2D (ISO/IEC 19775-1 clauses 14.3.2, 14.3.4, 14.3.7, 14.3.8). The
// texture of round ones is the square around the whole disk.
#include "geometry/builders.h"
#include "geometry/lines2d.h"
#include "geometry/round.h"
#include "geometry/texture_mapping.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

constexpr Vec3f front{0, 0, 1};

// Adds a vertex at a point of the unit disk.
void addOnDisk(Mesh& mesh, const Vec2f& at, float radius) {
  addVertex(mesh, {at.x * radius, at.y * radius, 0}, front, {0.5f + at.x / 2, 0.5f + at.y / 2});
}

Mesh finish(Mesh&& mesh, bool solid) {
  mesh.solid = solid;
  return finishRound(std::move(mesh));
}

// Makes triangles from the first vertex to each pair of the vertices after it.
Mesh fan(const Arc& arc, bool center, float radius, bool solid) {
  Mesh mesh;
  if (center) addOnDisk(mesh, {0, 0}, radius);
  for (const Vec2f& at : arc.points) addOnDisk(mesh, at, radius);
  const uint32_t count = uint32_t(mesh.ownPoints.size());
  for (uint32_t i = 1; i + 1 < count; i++) addTriangle(mesh, 0, i, i + 1);
  if (center && arc.whole) addTriangle(mesh, 0, count - 1, 1);
  return finish(std::move(mesh), solid);
}

Mesh ring(float inner, float outer, bool solid) {
  Mesh mesh;
  const Arc arc = wholeCircle();
  const float share = inner / outer;
  for (const Vec2f& at : arc.points) {
    addOnDisk(mesh, at, outer);
    addVertex(mesh, {at.x * inner, at.y * inner, 0}, front,
              {0.5f + at.x * share / 2, 0.5f + at.y * share / 2});
  }
  const uint32_t count = uint32_t(mesh.ownPoints.size());
  for (uint32_t i = 0; i < count; i += 2) {
    const uint32_t next = (i + 2) % count;
    addTriangle(mesh, i, next, i + 1);
    addTriangle(mesh, i + 1, next, next + 1);
  }
  return finish(std::move(mesh), solid);
}

} // namespace

Mesh buildArcClose2D(const nodes::ArcClose2D& node, const MeshOptions&, Faults& faults) {
  const bool chord = node.closureType == "CHORD";
  if (!chord && node.closureType != "PIE")
    faults.note("closureType is \"" + node.closureType + "\", expected PIE or CHORD: PIE is used");
  if (!isDrawable(node.radius, "radius", faults)) return {};
  const auto arc = arcBetween(node.startAngle, node.endAngle, faults);
  return arc ? fan(*arc, arc->whole || !chord, node.radius, node.solid) : Mesh();
}

Mesh buildDisk2D(const nodes::Disk2D& node, const MeshOptions&, Faults& faults) {
  if (!isDrawable(node.outerRadius, "outerRadius", faults)) return {};
  if (!(node.innerRadius >= 0 && node.innerRadius <= node.outerRadius)) {
    faults.note("innerRadius must be from 0 to outerRadius; nothing is drawn");
    return {};
  }
  if (node.innerRadius == node.outerRadius) return arcLine(wholeCircle(), node.outerRadius);
  if (node.innerRadius > 0) return ring(node.innerRadius, node.outerRadius, node.solid);
  return fan(wholeCircle(), true, node.outerRadius, node.solid);
}

Mesh buildRectangle2D(const nodes::Rectangle2D& node, const MeshOptions&, Faults& faults) {
  const float x = node.size.x / 2, y = node.size.y / 2;
  if (!isDrawable(x, "size", faults) || !isDrawable(y, "size", faults)) return {};
  Mesh mesh;
  addVertex(mesh, {-x, -y, 0}, front, {0, 0});
  addVertex(mesh, {x, -y, 0}, front, {1, 0});
  addVertex(mesh, {x, y, 0}, front, {1, 1});
  addVertex(mesh, {-x, y, 0}, front, {0, 1});
  addTriangle(mesh, 0, 1, 2);
  addTriangle(mesh, 0, 2, 3);
  return finish(std::move(mesh), node.solid);
}

// Triangles may run either way around; all of them face +z. Vertices after the last whole triangle
// are ignored.
Mesh buildTriangleSet2D(const nodes::TriangleSet2D& node, const MeshOptions& options,
                        Faults& faults) {
  const MFVec2f& from = node.vertices;
  if (from.size() >= UINT32_MAX / 2) {
    faults.note("too many points");
    return {};
  }
  Mesh mesh;
  for (uint32_t i = 0; i + 2 < from.size(); i += 3) {
    if (!isFinite(from[i]) || !isFinite(from[i + 1]) || !isFinite(from[i + 2])) {
      faults.add(Fault::notFinite, i / 3);
      continue;
    }
    if (mesh.ownIndices.size() / 3 >= triangleLimit(options)) {
      faults.add(Fault::overLimit, i / 3);
      break;
    }
    const uint32_t first = uint32_t(mesh.ownPoints.size());
    for (uint32_t k = 0; k < 3; k++) addVertex(mesh, {from[i + k].x, from[i + k].y, 0}, front, {});
    const auto& p = mesh.ownPoints;
    const V3d a = toV3d(p[first]);
    const bool turned = (toV3d(p[first + 1]) - a).cross(toV3d(p[first + 2]) - a).z < 0;
    const size_t before = mesh.ownIndices.size();
    addTriangle(mesh, first, first + (turned ? 2 : 1), first + (turned ? 1 : 2));
    if (mesh.ownIndices.size() == before) faults.add(Fault::noArea, i / 3);
  }
  mesh.ownTexCoords.clear();
  if (options.needTexCoords)
    mesh.ownTexCoords = defaultTextureMapping(mesh.ownPoints, mesh.ownIndices);
  return finish(std::move(mesh), node.solid);
}

} // namespace xvrml
