// sphere.cpp: builds a Sphere (clause 6.43). The ray tracer intersects spheres exactly, so only the
// radius is stored.
#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {

Mesh buildSphere(const nodes::Sphere& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  float radius = std::abs(node.radius);
  if (!(radius > 0) || !isFinite(radius)) {
    faults.note("radius must be positive; nothing is drawn");
    return mesh;
  }
  if (node.radius < 0) faults.note("negative radius taken as positive");
  mesh.kind = Mesh::Kind::sphere;
  mesh.radius = radius;
  mesh.solid = node.solid;
  return mesh;
}

} // namespace xvrml
