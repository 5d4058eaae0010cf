// lines2d.cpp: the lines and points of X3D in the plane z = 0: Arc2D, Circle2D, Polyline2D and
// Polypoint2D (ISO/IEC 19775-1 clauses 14.3.1, 14.3.3, 14.3.5, 14.3.6).
#include "geometry/lines2d.h"

#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {

Mesh arcLine(const Arc& arc, float radius) {
  Mesh mesh;
  mesh.kind = Mesh::Kind::lines;
  mesh.solid = false;
  for (const Vec2f& at : arc.points) mesh.ownPoints.push_back({at.x * radius, at.y * radius, 0});
  const uint32_t count = uint32_t(arc.points.size());
  for (uint32_t i = 0; i + 1 < count; i++)
    mesh.ownIndices.insert(mesh.ownIndices.end(), {i, i + 1});
  if (arc.whole) mesh.ownIndices.insert(mesh.ownIndices.end(), {count - 1, 0});
  mesh.viewOwn();
  return mesh;
}

Mesh buildArc2D(const nodes::Arc2D& node, const MeshOptions&, Faults& faults) {
  if (!isDrawable(node.radius, "radius", faults)) return {};
  const auto arc = arcBetween(node.startAngle, node.endAngle, faults);
  return arc ? arcLine(*arc, node.radius) : Mesh();
}

Mesh buildCircle2D(const nodes::Circle2D& node, const MeshOptions&, Faults& faults) {
  return isDrawable(node.radius, "radius", faults) ? arcLine(wholeCircle(), node.radius) : Mesh();
}

// Points that are not finite interrupt the line.
Mesh buildPolyline2D(const nodes::Polyline2D& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  const MFVec2f& points = node.lineSegments;
  if (points.size() >= UINT32_MAX / 2) {
    faults.note("too many points");
    return mesh;
  }
  bool follows = false; // the last point of the mesh is the one before
  for (size_t i = 0; i < points.size(); i++) {
    if (!isFinite(points[i])) {
      faults.add(Fault::notFinite, i);
      follows = false;
      continue;
    }
    const Vec3f point{points[i].x, points[i].y, 0};
    if (follows && mesh.ownPoints.back() == point) continue;
    const uint32_t vertex = uint32_t(mesh.ownPoints.size());
    mesh.ownPoints.push_back(point);
    if (follows) mesh.ownIndices.insert(mesh.ownIndices.end(), {vertex - 1, vertex});
    follows = true;
  }
  if (mesh.ownIndices.empty()) {
    if (!points.empty()) faults.add(Fault::fewVertices, 0);
    return {};
  }
  mesh.kind = Mesh::Kind::lines;
  mesh.solid = false;
  mesh.viewOwn();
  return mesh;
}

Mesh buildPolypoint2D(const nodes::Polypoint2D& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  if (node.point.size() >= UINT32_MAX) {
    faults.note("too many points");
    return mesh;
  }
  for (size_t i = 0; i < node.point.size(); i++) {
    if (!isFinite(node.point[i])) {
      faults.add(Fault::notFinite, i);
      continue;
    }
    mesh.ownIndices.push_back(uint32_t(mesh.ownPoints.size()));
    mesh.ownPoints.push_back({node.point[i].x, node.point[i].y, 0});
  }
  if (mesh.ownIndices.empty()) return {};
  mesh.kind = Mesh::Kind::points;
  mesh.solid = false;
  mesh.viewOwn();
  return mesh;
}

} // namespace xvrml
