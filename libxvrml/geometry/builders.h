// builders.h: one function per geometry node. buildMesh (mesh.cpp) chooses among them. Called on
// the caller's thread.
#pragma once

#include "geometry/faults.h"
#include "geometry/mesh.h"
#include "xvrml/nodes.h"

namespace xvrml {

Mesh buildBox(const nodes::Box& node, const MeshOptions& options, Faults& faults);
Mesh buildCone(const nodes::Cone& node, const MeshOptions& options, Faults& faults);
Mesh buildCylinder(const nodes::Cylinder& node, const MeshOptions& options, Faults& faults);
Mesh buildSphere(const nodes::Sphere& node, const MeshOptions& options, Faults& faults);
Mesh buildIndexedFaceSet(const nodes::IndexedFaceSet& node, const MeshOptions& options,
                         Faults& faults);
Mesh buildIndexedLineSet(const nodes::IndexedLineSet& node, const MeshOptions& options,
                         Faults& faults);
Mesh buildPointSet(const nodes::PointSet& node, const MeshOptions& options, Faults& faults);
Mesh buildElevationGrid(const nodes::ElevationGrid& node, const MeshOptions& options,
                        Faults& faults);
Mesh buildExtrusion(const nodes::Extrusion& node, const MeshOptions& options, Faults& faults);
Mesh buildText(const nodes::Text& node, const MeshOptions& options, Faults& faults);

// Return the arrays of property nodes, also through a prototype instance. They return an empty span
// for NULL and for nodes of another type.
std::span<const Vec3f> coordinates(const NodeRef& node);
std::span<const Vec3f> normalVectors(const NodeRef& node);
std::span<const Color> colorValues(const NodeRef& node);
std::span<const Vec2f> textureCoordinates(const NodeRef& node);

inline uint64_t triangleLimit(const MeshOptions& options) {
  return options.limits ? options.limits->triangles : Limits().triangles;
}

// Returns the name of the limit on triangles for messages.
inline std::string_view triangleLimitName(const MeshOptions& options) {
  return options.limitName.empty() ? "the limit 'triangles'" : options.limitName;
}

} // namespace xvrml
