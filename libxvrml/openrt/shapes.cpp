// shapes.cpp: what is written into an open object: instances of the objects below, shapes with their arrays as they are, the
// matrix, the surface. The other half of Objects.
#include <algorithm>

#include "openrt/objects.h"
#include "xvrml/nodes.h"

namespace xvrml::mapping {

namespace {
RTenum modeOf(Mesh::Kind kind) {
  return kind == Mesh::Kind::lines ? RT_LINES : kind == Mesh::Kind::points ? RT_POINTS : RT_TRIANGLES;
}
} // namespace

void Objects::enter(ItemId id, int32_t at, const Matrix& matrix) {
  const Item& item = graph_.items[id];
  if (at == none && !item.draws) return;
  if (at != none && places_.all[size_t(at)].split) {
    Place& place = places_.all[size_t(at)];
    const bool turns = item.kind == Kind::billboard && live_;
    place.base = matrix;
    place.instance = instantiate(partOfPlace(size_t(at)), compose(graph_.below(matrix, item), places_.turns[size_t(at)]), 0,
                                 item.moves || turns);
  } else if (at == none && item.own != Own::none) {
    const RTid instance = instantiate(partOfItem(id), graph_.below(matrix, item), 0, item.moves);
    if (item.moves) keep(id, instance, matrix);
  } else {
    stack_.push_back({id, at, graph_.below(matrix, item)});
  }
}

void Objects::expand(const Step& step) {
  const Item& item = graph_.items[step.item];
  if (item.kind == Kind::shape) return writeShape(step.item, step.matrix);
  const bool oneLevel = item.kind == Kind::lod; // one that has no place of its own: see summarise
  for (size_t c = oneLevel ? std::min(item.children.size(), size_t(1)) : item.children.size(); c-- > 0;) {
    const int32_t at = step.place == none ? none : places_.children[places_.all[size_t(step.place)].firstChild + c];
    enter(item.children[c], at, step.matrix);
  }
}

void Objects::drain() {
  while (!stack_.empty()) {
    const Step step = stack_.back();
    stack_.pop_back();
    expand(step);
  }
}

// dynamic: events or the camera will move it.
RTid Objects::instantiate(int32_t id, const Matrix& matrix, uint32_t number, bool dynamic) {
  const bool usable = finite(matrix);
  if (!usable && !dynamic) return 0; // scales that multiply beyond all numbers: out of sight
  rtLoadName(number);
  load(usable ? matrix : scaling(Vector(0)));
  const RTid instance = rtInstantiateObject(parts_[size_t(id)].object);
  if (instance == 0) {
    report(world_.diagnostics, {}, "a group cannot be placed");
    return 0;
  }
  if (dynamic) rtInstanceHint(instance, RT_DYNAMIC);
  parts_[size_t(writing_)].uses.push_back(id);
  ++parts_[size_t(id)].instances;
  ++instances_;
  return instance;
}

void Objects::keep(ItemId item, RTid instance, const Matrix& base) {
  if (instance == 0) return;
  placed_[item].push_back({instance, writing_, base});
  parts_[size_t(writing_)].moving.push_back(item);
}

// What a shape draws has the shape's number as its name, also in an object that holds many shapes or has many instances: the id
// channel tells them apart.
void Objects::writeShape(ItemId id, const Matrix& matrix) {
  const Item& item = graph_.items[id];
  Node* appearance = static_cast<nodes::Shape&>(*item.node).appearance.get();
  if (item.viaMesh) {
    const int32_t part = partOfMesh(graph_.meshes.equal(item.mesh));
    const RTid instance = instantiate(part, matrix, item.number, false);
    if (instance != 0) rtInstanceShader(instance, surfaces_.of(appearance, false).shader);
    if (item.recolored) keep(id, instance, matrix);
  } else {
    const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
    if (extent.primitives == 0 || !finite(matrix)) return;
    const Surface surface = surfaces_.of(appearance, item.lines);
    rtLoadName(item.number);
    load(matrix);
    draw(item.mesh, surface, isTextured(appearance));
  }
  ++parts_[size_t(writing_)].shapes;
  report(world_.diagnostics, item.node->source, "Shape");
}

void Objects::draw(int32_t mesh, const Surface& surface, bool textured) {
  const Mesh& m = graph_.meshes.get(mesh);
  const Meshes::Extent extent = graph_.meshes.extent(mesh);
  if (extent.primitives == 0) return;
  Part& part = parts_[size_t(writing_)];
  part.primitives += extent.primitives;
  if (m.kind == Mesh::Kind::triangles) part.triangles += extent.primitives;
  ++part.drawCalls;
  rtBindShader(surface.shader);
  (m.solid ? rtEnable : rtDisable)(RT_CULL_FACE);
  (m.ccw ? rtDisable : rtEnable)(RT_CW_FRONT);
  if (m.kind == Mesh::Kind::sphere) {
    rtSphere(m.radius);
  } else if (m.indices.size() < m.points.size()) { // a Coordinate that several geometries share: each takes its part
    Mesh used;
    compact(m, used);
    drawArrays(used, surface, textured);
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
