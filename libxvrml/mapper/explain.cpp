// explain.cpp: OpenRTMapper::explain(): lists each object with its path of names and the reason for
// its existence.
#include <algorithm>

#include <fmt/format.h>

#include "mapper/mapper_impl.h"
#include "xvrml/change.h"
#include "xvrml/renderer.h"

namespace xvrml {

using namespace mapper;

namespace {

constexpr size_t longestPath = 12;     // limit on the names in a path
constexpr uint64_t bytesOfDraw = 1200; // a draw call without its arrays

std::string ownName(const Graph& graph, const Item& item) {
  if (item.name != 0) return graph.names[item.name];
  if (!item.node) return "world";
  return item.node->source.line == 0
             ? item.node->type().name
             : fmt::format("{}:{}", item.node->type().name, item.node->source.line);
}

std::string pathOf(const Graph& graph, ItemId id) {
  std::vector<std::string> names{ownName(graph, graph.items[id])};
  for (size_t steps = 0;
       steps < 1000 && graph.items[id].parentCount > 0 && names.size() < longestPath; ++steps) {
    id = graph.parents[graph.items[id].firstParent];
    if (graph.items[id].name != 0) names.push_back(graph.names[graph.items[id].name]);
  }
  std::string path;
  for (size_t i = names.size(); i-- > 0;) path += (path.empty() ? "" : "/") + names[i];
  return path;
}

std::string megabytes(uint64_t bytes) {
  return bytes >= 10'000'000 ? fmt::format("{} MB", bytes / 1'000'000)
                             : fmt::format("{} kB", (bytes + 999) / 1000);
}

std::string used(const Graph& graph, const Part& part, uint64_t primitives) {
  const uint64_t saved = savedByInstances(primitives, part.instances);
  (void)graph;
  return fmt::format("USEd {} times, saves {}", part.instances, megabytes(saved));
}

std::string reasonOf(const Node& node, Change kind) {
  const std::string reason = reachReason(node, kind);
  return "split: " + (reason.empty() ? std::string("events reach it") : reason);
}

// Returns the reason from the node below a Shape that events reach with such a change.
std::string reasonBelow(Node& node, Change kind) {
  const Reach reach = reachBelow(node, kind);
  return reach ? reasonOf(*reach.node, kind) : "split: events reach it";
}

std::string itemReason(const Graph& graph, const Item& item, const Part& part) {
  switch (item.objectReason) {
  case ObjectReason::shared: return used(graph, part, item.primitives);
  case ObjectReason::wanted: return "split: ORTInstance";
  case ObjectReason::merged: return "merged: ORTStatic";
  case ObjectReason::clipped: return "merged: ClipPlanes cut it";
  case ObjectReason::transform: return reasonOf(*item.node, Change::transform);
  case ObjectReason::children:
    return item.awaited ? "split: it is still to be loaded"
                        : reasonOf(*item.node, Change::children);
  case ObjectReason::appearance: return "split: events reach the colour of its lines";
  case ObjectReason::geometry:
    return reasonBelow(*renderedNode(static_cast<nodes::Shape&>(*item.node).geometry.get()),
                       Change::geometry);
  case ObjectReason::none: break;
  }
  return {};
}

std::string placeReason(const Graph& graph, const Item& item, const Part& part) {
  if (!item.node)
    return fmt::format("merged static geometry of {} shapes{}", part.shapes,
                       part.shapes > 1 ? ", each with its own material" : "");
  if (part.level != none) return fmt::format("split: level {} of an LOD", part.level);
  if (item.kind == Kind::lod) return "split: LOD follows the viewer";
  if (item.kind == Kind::billboard) return "split: Billboard follows the viewer";
  if (isSplit(item.objectReason)) return itemReason(graph, item, part);
  return item.scopes ? "split: scope of a light or a LocalFog" : "";
}

} // namespace

std::vector<ExplainedObject> OpenRTMapper::explain() const {
  Impl& m = *impl_;
  std::vector<ExplainedObject> list;
  std::vector<ItemId> shapeOf(m.graph.meshes.size(), 0); // by mesh: the first shape that uses it
  std::vector<uint32_t> geometries(m.graph.meshes.size(), 0);
  std::vector<uint8_t> counted(m.graph.meshes.size(), 0);
  for (const ItemId id : m.graph.order) {
    const Item& item = m.graph.items[id];
    if (item.kind != Kind::shape || !item.viaMesh) continue;
    const auto mesh = size_t(m.graph.meshes.equal(item.mesh));
    if (shapeOf[mesh] == 0) shapeOf[mesh] = id;
    if (!std::exchange(counted[size_t(item.mesh)], 1)) ++geometries[mesh];
  }
  for (const Part& part : m.objects.parts()) {
    if (!part.defined || part.kind == Part::Kind::nothing) continue;
    ExplainedObject object;
    object.triangles = part.triangles;
    object.shapes = part.shapes;
    object.bytes = part.primitives * bytesOfPrimitive + part.drawCalls * bytesOfDraw +
                   part.uses.size() * bytesOfInstance;
    object.instances = part.instances;
    if (part.kind == Part::Kind::mesh) {
      Node& geometry = m.graph.meshes.geometry(part.mesh);
      const ItemId shape = shapeOf[size_t(part.mesh)];
      object.name = (shape == 0 ? "" : pathOf(m.graph, shape) + "/") +
                    (geometry.defName.empty()
                         ? fmt::format("{}:{}", geometry.type().name, geometry.source.line)
                         : geometry.defName);
      const uint32_t equal = geometries[size_t(part.mesh)];
      if (m.graph.meshes.dynamic(part.mesh))
        object.reason = reasonBelow(geometry, Change::geometry);
      else if (shape != 0 && part.instances < 2 && m.graph.items[shape].recolored)
        object.reason = reasonOf(*m.graph.items[shape].node, Change::appearance);
      else
        object.reason = used(m.graph, part, part.primitives) +
                        (equal > 1 ? fmt::format(", {} geometries equal by content", equal) : "");
    } else {
      const Item& item = m.graph.items[part.item];
      object.name = pathOf(m.graph, part.item);
      object.reason = part.kind == Part::Kind::place ? placeReason(m.graph, item, part)
                                                     : itemReason(m.graph, item, part);
    }
    list.push_back(std::move(object));
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.triangles > b.triangles; });
  return list;
}

} // namespace xvrml
