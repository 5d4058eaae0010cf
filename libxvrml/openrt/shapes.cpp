// shapes.cpp: how one shape is handed to OpenRT: arrays as they are, the matrix, the surface. The other half of Objects.
#include "openrt/objects.h"

#include "xvrml/nodes.h"

namespace xvrml::mapping {

namespace {
// A geometry that several Shape nodes use becomes an object when it is worth it; see summary.cpp for the numbers' meaning.
constexpr uint64_t smallest = 32, worth = 2048;

RTenum modeOf(Mesh::Kind kind) {
  return kind == Mesh::Kind::lines ? RT_LINES : kind == Mesh::Kind::points ? RT_POINTS : RT_TRIANGLES;
}
} // namespace

RTid Objects::begin() {
  ++objects_;
  return made_.emplace_back(rtBeginObject(0));
}

void Objects::remove() {
  for (const RTid object : made_) rtDeleteObject(object);
  made_.clear();
}

RTid Objects::instantiate(RTid object, const Matrix& matrix, uint32_t name) {
  if (!finite(matrix)) return 0; // scales that multiply beyond all numbers: out of sight
  ++instances_;
  rtLoadName(name);
  load(matrix);
  const RTid instance = rtInstantiateObject(object);
  if (instance == 0) report(world_.diagnostics, {}, "a group cannot be placed");
  return instance;
}

bool Objects::sharesGeometry(int32_t mesh) {
  const uint64_t users = graph_.meshes.users(mesh);
  if (users < 2) return false;
  const Meshes::Extent extent = graph_.meshes.extent(mesh);
  return extent.kind == Mesh::Kind::triangles && extent.primitives >= smallest && extent.primitives * (users - 1) >= worth;
}

uint32_t Objects::givenName(const Item& item, uint32_t name) {
  if (item.name != 0) name = item.name;
  if (name != 0 || inShared_ || !item.node) return name;
  return graph_.nameId(item.node->type().name);
}

void Objects::writeShape(const Item& item, const Matrix& matrix, uint32_t name) {
  const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
  if (extent.primitives == 0 || !finite(matrix)) return;
  Node* appearance = static_cast<nodes::Shape&>(*item.node).appearance.get();
  const Surface surface = surfaces_.of(appearance, item.lines);
  if (sharesGeometry(item.mesh)) {
    const RTid instance = instantiate(meshObjects_[size_t(item.mesh)], matrix, givenName(item, name));
    if (instance != 0) rtInstanceShader(instance, surface.shader);
  } else {
    rtLoadName(givenName(item, name));
    load(matrix);
    draw(item.mesh, surface, isTextured(appearance));
  }
  report(world_.diagnostics, item.node->source, "Shape");
}

void Objects::draw(int32_t mesh, const Surface& surface, bool textured) {
  const Mesh& m = graph_.meshes.get(mesh);
  rtBindShader(surface.shader);
  (m.solid ? rtEnable : rtDisable)(RT_CULL_FACE);
  (m.ccw ? rtDisable : rtEnable)(RT_CW_FRONT);
  if (m.kind == Mesh::Kind::sphere) {
    rtSphere(m.radius);
  } else if (m.indices.size() < m.points.size()) { // a Coordinate that several geometries share: each takes its part
    Mesh part;
    compact(m, part);
    drawArrays(part, surface, textured);
  } else {
    drawArrays(m, surface, textured);
  }
  rtBindShader(0);
}

void Objects::drawArrays(const Mesh& m, const Surface& surface, bool textured) {
  rtVertexPointer(3, RT_FLOAT, sizeof(Vec3f), m.points.data());
  rtNormalPointer(RT_FLOAT, sizeof(Vec3f), m.normals.empty() ? nullptr : m.normals.data());
  rtTexCoordPointer(2, RT_FLOAT, sizeof(Vec2f), textured && !m.texCoords.empty() ? m.texCoords.data() : nullptr);
  const bool plain = m.colors.empty() && m.kind != Mesh::Kind::triangles; // lines and points take the material's emissive colour
  if (!m.colors.empty() && !linear_) {
    rtColorPointer(3, RT_FLOAT, sizeof(Color), m.colors.data());
  } else if (!m.colors.empty() || plain) {
    colors_.clear();
    colors_.reserve(3 * m.points.size());
    for (size_t i = 0; i < m.points.size(); ++i) {
      const Color c = plain ? surface.lineColor : convert(m.colors[i], true);
      colors_.insert(colors_.end(), {c.r, c.g, c.b});
    }
    rtColorPointer(3, RT_FLOAT, 0, colors_.data());
  } else {
    rtColorPointer(3, RT_FLOAT, 0, nullptr);
  }
  rtDrawElements(modeOf(m.kind), m.indices.size(), m.indices.data(), m.points.size());
}

} // namespace xvrml::mapping
