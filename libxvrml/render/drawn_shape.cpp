// drawn_shape.cpp: what a renderer asks of a node or a Shape in its place.
#include "geometry/half_space.h"
#include "render/arrays.h"
#include "render/walk.h"
#include "xvrml/walk.h"

namespace xvrml {

Visit NodeRenderer::render(Node& /*node*/, const RenderState& /*state*/) { return Visit::children; }
void NodeRenderer::leave(Node& /*node*/, const RenderState& /*state*/) {}
void Renderer::draw(const DrawnShape& /*shape*/) {}

std::string_view RenderState::name() const {
  for (size_t i = path.size(); i-- > 0;)
    if (!path[i]->defName.empty()) return path[i]->defName;
  return {};
}

const GeometryArrays& DrawnShape::mesh() const {
  if (!mesh_)
    mesh_ = arraysOf(geometry, kept(), walk_.options().sphereSteps, walk_.world().options.limits);
  return *mesh_;
}

const AppearanceParts& DrawnShape::appearance() const {
  if (!appearance_) appearance_ = resolveAppearance(shape.appearance.get());
  return *appearance_;
}

const std::vector<std::array<double, 4>>& DrawnShape::kept() const {
  if (kept_) return *kept_;
  kept_.emplace();
  const Matrix toWorld = fromArray(state.matrix);
  for (const auto& [a, b, c, d] : state.kept) {
    const HalfSpace local = inside({Vector(a, b, c), d}, toWorld);
    kept_->push_back({local.normal.x, local.normal.y, local.normal.z, local.offset});
  }
  return *kept_;
}

uint64_t DrawnShape::uses() const { return walk_.usesOf(geometry); }

namespace {

Reach reachOfNode(const Node& node, Change change) {
  return node.live && reaches(node, change) ? Reach{&node, change} : Reach{};
}

// Returns the first node of a path that events reach with such a change.
Reach reachOfPath(std::span<Node* const> path, Change change) {
  for (const Node* node : path)
    if (const Reach reach = reachOfNode(*node, change)) return reach;
  return {};
}

} // namespace

Reach reachBelow(const Node& node, Change change) {
  if (const Reach reach = reachOfNode(node, change); reach || !node.live) return reach;
  for (const FieldInfo& field : node.type().fields) {
    if (field.type != FieldType::SFNode || !holdsValue(field)) continue;
    const Node* held = renderedNode(static_cast<const SFNode*>(node.storage(field))->get());
    if (!held) continue;
    if (const Reach reach = reachOfNode(*held, change)) return reach;
  }
  return {};
}

Reach DrawnShape::reachOfMatrix() const { return reachOfPath(state.path, Change::transform); }
Reach DrawnShape::reachOfPresence() const { return reachOfPath(state.path, Change::children); }
Reach DrawnShape::reachOfGeometry() const { return reachBelow(geometry, Change::geometry); }

Reach DrawnShape::reachOfAppearance() const {
  Reach found = reachOfNode(shape, Change::appearance);
  if (found) return found;
  walk(std::vector<Node*>{shape.appearance.get()}, [&](Node& node, std::vector<Node*>& open) {
    found = reachOfNode(node, Change::appearance);
    if (!found) found = reachOfNode(node, Change::shader);
    if (Node* rendered = renderedNode(&node); rendered != &node)
      open.push_back(rendered);
    else
      appendChildren(node, open);
    return !found;
  });
  return found;
}

} // namespace xvrml
