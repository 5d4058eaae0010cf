// builders.h: the list of geometry nodes, with one function per node. buildMesh (mesh.cpp) chooses
// among them. Called on the caller's thread.
#pragma once

#include "geometry/faults.h"
#include "geometry/mesh.h"
#include "xvrml/nodes.h"

namespace xvrml {

// The geometry nodes, those that worlds use most first. Most have a file of their own, related ones
// share one: Mesh buildBox(const nodes::Box&, const MeshOptions&, Faults&) and so on.
#define XVRML_GEOMETRY_NODES(X)                                                                    \
  X(IndexedFaceSet)                                                                                \
  X(Box)                                                                                           \
  X(Cone)                                                                                          \
  X(Cylinder)                                                                                      \
  X(Sphere)                                                                                        \
  X(IndexedLineSet)                                                                                \
  X(PointSet)                                                                                      \
  X(ElevationGrid)                                                                                 \
  X(Extrusion)                                                                                     \
  X(Text)                                                                                          \
  X(IndexedTriangleSet)                                                                            \
  X(TriangleSet)                                                                                   \
  X(IndexedTriangleStripSet)                                                                       \
  X(IndexedTriangleFanSet)                                                                         \
  X(TriangleStripSet)                                                                              \
  X(TriangleFanSet)                                                                                \
  X(IndexedQuadSet)                                                                                \
  X(QuadSet)                                                                                       \
  X(LineSet)                                                                                       \
  X(Rectangle2D)                                                                                   \
  X(Disk2D)                                                                                        \
  X(Circle2D)                                                                                      \
  X(Polyline2D)                                                                                    \
  X(Polypoint2D)                                                                                   \
  X(TriangleSet2D)                                                                                 \
  X(Arc2D)                                                                                         \
  X(ArcClose2D)                                                                                    \
  X(ORTQuadric)                                                                                    \
  X(ORTAsphere)                                                                                    \
  X(GeoElevationGrid)                                                                              \
  X(NurbsPatchSurface)                                                                             \
  X(NurbsTrimmedSurface)                                                                           \
  X(NurbsCurve)                                                                                    \
  X(NurbsSweptSurface)                                                                             \
  X(NurbsSwungSurface)

#define XVRML_DECLARE_BUILDER(name)                                                                \
  Mesh build##name(const nodes::name& node, const MeshOptions& options, Faults& faults);
XVRML_GEOMETRY_NODES(XVRML_DECLARE_BUILDER)
#undef XVRML_DECLARE_BUILDER

// The colours of a Color or ColorRGBA.
struct ColorValues {
  std::span<const Color> rgb; // the node's, or `own`
  std::vector<Color> own;
  std::vector<float> alphas; // opacity of each colour, 0 to 1; empty for a Color
};

// The points of a TextureCoordinate, TextureCoordinate3D or TextureCoordinate4D.
struct TexCoordValues {
  std::span<const Vec2f> points; // the node's, or `own`
  std::vector<Vec2f> own;
  std::vector<Vec4f> places; // (s, t, r, q) of each point; empty for a TextureCoordinate
};

// The points of a Coordinate or CoordinateDouble.
struct Coordinates {
  std::span<const Vec3f> points; // the node's, or `own`
  std::vector<Vec3f> own;
};

// Return the arrays of property nodes as they are drawn, also through a prototype instance. They
// return an empty span for NULL and for nodes of another type.
Coordinates coordinates(const NodeRef& node);
std::span<const Vec3f> normalVectors(const NodeRef& node);
ColorValues colorValues(const NodeRef& node);
TexCoordValues textureCoordinates(const NodeRef& node);

// Returns the fog coordinate of each of so many points; empty without a FogCoordinate. The last
// depth holds for all further points.
std::vector<float> fogCoordinates(const NodeRef& node, size_t points);

inline uint64_t triangleLimit(const MeshOptions& options) {
  return options.limits ? options.limits->triangles : Limits().triangles;
}

// Returns the name of the limit on triangles for messages.
inline std::string_view triangleLimitName(const MeshOptions& options) {
  return options.limitName.empty() ? "the limit 'triangles'" : options.limitName;
}

} // namespace xvrml
