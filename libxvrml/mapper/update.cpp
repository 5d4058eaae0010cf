// update.cpp: turns changed fields into the least work that brings the scene up to date. Called by
// the mapper between frames, on its thread.
//
// Grouping (summary.cpp) keeps everything apart that events are known to reach. So such a change
// touches instances, one object or a shader's parameters. Anything else is part of something
// larger: its first change causes a regrouping, because the engine now knows that it is reached.
// Later changes of it are cheap.
#include <algorithm>
#include <unordered_set>

#include "geometry/node_matrix.h"
#include "mapper/mapper_impl.h"
#include "xvrml/change.h"
#include "xvrml/walk.h"

namespace xvrml {

using namespace mapper;

struct OpenRTMapper::Impl::Work {
  bool regroup = false;
  std::vector<ItemId> rewrite;    // items whose content is drawn differently
  std::vector<ItemId> replace;    // items that are placed differently
  std::vector<int32_t> meshes;    // meshes that have changed
  std::vector<Node*> appearances; // appearances with new properties, each once
  SeenNodes visited;              // by the upward walk from appearance nodes
};

namespace {

bool isAppearance(const Node& node) {
  return node.type().index == nodes::Appearance::typeIndex ||
         node.type().index == nodes::ORTAppearance::typeIndex;
}

// Walks up through everything except groups and shapes, including prototype instances. The walk
// continues above a node if visit returns true for it.
template <class Visit> void walkHolders(Node& first, SeenNodes& visited, const Visit& visit) {
  walk(std::vector<Node*>{&first}, visited, [&](Node& node, std::vector<Node*>& open) {
    if (visit(node)) holdersOf(node, open);
  });
}

// Visits the shapes that hold a geometry or appearance node.
template <class Visit> void forEachShape(const Graph& graph, Node& part, const Visit& visit) {
  SeenNodes visited;
  walkHolders(part, visited, [&](Node& node) {
    const ItemId item = graph.find(&node);
    if (item != 0 && graph.items[item].kind == Kind::shape) visit(item);
    return &node == &part || node.type().index < 0 || node.type().expand;
  });
}

} // namespace

void OpenRTMapper::Impl::update(const FieldChanges& changes) {
  Work work;
  for (const FieldChange& change : changes) {
    if (!change.node || !change.field) continue; // the roots: handled by planRoots()
    Node& node = *change.node;
    switch (change.field->change) {
    case Change::transform: transformChanged(work, node); break;
    case Change::geometry: geometryChanged(work, node); break;
    case Change::appearance:
    case Change::shader: appearanceChanged(work, node); break;
    case Change::light: switchChanged(work, node); break;
    case Change::view:
      environment.changed(node);
      viewsStale = true;
      break;
    case Change::children:
      if (graph.find(&node) != 0) awaiting.push_back(change.node);
      break;
    case Change::time:
    case Change::none: break;
    }
  }
  planChanged(work);
  newSurfaces(work);
  if (work.regroup) regroup();
  std::erase_if(awaiting, [&](const NodeRef& node) { return graph.find(node.get()) == 0; });
  for (const int32_t mesh : work.meshes) objects.meshChanged(mesh);
  std::erase_if(work.rewrite, [&](ItemId id) { return !graph.items[id].planned; });
  std::erase_if(work.replace, [&](ItemId id) { return !graph.items[id].planned; });
  if (!work.rewrite.empty()) objects.contentChanged(work.rewrite);
  if (!work.replace.empty()) objects.placingChanged(work.replace);
}

// Plans what has other children, and keeps for the next update what awaits large meshes.
void OpenRTMapper::Impl::planChanged(Work& work) {
  rootsAwait = patient && graph.awaits(nullptr);
  if (!rootsAwait) work.regroup |= graph.planRoots();
  std::vector<NodeRef> later;
  SeenNodes seen;
  for (const NodeRef& node : std::exchange(awaiting, {})) {
    const ItemId item = graph.find(node.get());
    if (item == 0 || !seen.insert(node.get())) continue;
    if (patient && graph.awaits(node.get())) {
      later.push_back(node);
      continue;
    }
    graph.plan(item);
    work.regroup = true;
  }
  awaiting = std::move(later);
}

void OpenRTMapper::Impl::transformChanged(Work& work, Node& node) {
  const ItemId id = graph.find(&node);
  if (id == 0) return;
  viewsStale |= graph.items[id].placeDependent;
  boundsStale = true;
  const Kind kind = graph.items[id].kind;
  if (kind == Kind::billboard || kind == Kind::clipPlane) return; // updated with every frame
  if (!hasMatrix(node)) {
    graph.plan(id);
    work.regroup = true;
    return;
  }
  const Item& item = graph.items[id];
  if (!item.draws || objects.moved(id)) return;
  if (!item.merged) {
    work.regroup = true;
    return;
  }
  work.rewrite.push_back(id);
  work.replace.push_back(id);
}

// Handles a change of a geometry node or of a node that it holds.
void OpenRTMapper::Impl::geometryChanged(Work& work, Node& first) {
  SeenNodes visited;
  const bool vectorsOnly = first.type().index == nodes::Coordinate::typeIndex ||
                           first.type().index == nodes::Normal::typeIndex;
  walkHolders(first, visited, [&](Node& node) {
    const int32_t mesh = graph.meshes.find(&node);
    if (mesh == none) graph.meshes.spoil(node);
    if (mesh == none) return node.type().index < 0 || !planOf(node.type());
    const bool expected = graph.meshes.dynamic(mesh);
    const bool otherSurface = graph.meshes.switchedSurface(mesh);
    graph.meshes.changed(mesh, vectorsOnly);
    work.meshes.push_back(mesh);
    boundsStale = countsStale = true;
    forEachShape(graph, node, [&](ItemId shape) {
      const Item& item = graph.items[shape];
      if (!expected && !item.merged) work.regroup = true;
      if (!expected || item.merged || item.objectReason != ObjectReason::none || !item.viaMesh ||
          otherSurface)
        work.rewrite.push_back(shape);
    });
    return false;
  });
}

// Handles a change of a Shape, of an appearance or of a node that it holds.
void OpenRTMapper::Impl::appearanceChanged(Work& work, Node& first) {
  if (const ItemId id = graph.find(&first)) {
    if (graph.items[id].kind != Kind::shape) return;
    lightStale = true; // it may have got or lost an ORTAppearance
    if (objects.recolored(id)) return textured(work, id);
    textured(work, id);
    work.rewrite.push_back(id);
    work.regroup |=
        !graph.items[id].merged && graph.items[id].objectReason != ObjectReason::appearance;
    return;
  }
  const bool cube = first.type().is("environmentTexture");
  if (cube) cubes.changed(first);
  const bool volume = volumes.changed(first);
  if (!cube && first.type().is("texture") && !textures.changed(first) && !volume)
    return; // only the picture changed
  walkHolders(first, work.visited, [&](Node& node) {
    if (node.type().index == nodes::ORTShader::typeIndex) custom.changed(node);
    if (node.type().index == nodes::ORTLight::typeIndex) lights.changed(node);
    if (first.type().is("textureProperty") && node.type().is("texture")) textures.changed(node);
    // For the shader of an ORTBackground, the pictures of TextureBackgrounds and EnvironmentLights.
    environment.changed(node);
    if (!isAppearance(node)) return node.type().index < 0 || !planOf(node.type());
    work.appearances.push_back(&node);
    return false;
  });
}

void OpenRTMapper::Impl::newSurfaces(Work& work) {
  for (Node* appearance : work.appearances) {
    const Surfaces::Effect effect = surfaces.update(*appearance);
    if (!effect.other && !effect.colored && !effect.textured) continue;
    forEachShape(graph, *appearance, [&](ItemId shape) {
      const Item& item = graph.items[shape];
      if (effect.textured) textured(work, shape);
      if (item.lines) {
        if (!effect.colored) return;
        work.rewrite.push_back(shape);
        work.regroup |= !item.merged && item.objectReason == ObjectReason::none;
      } else if (effect.other ? !objects.recolored(shape) : effect.textured && !item.viaMesh) {
        work.rewrite.push_back(shape);
      }
    });
  }
}

// Adds texture coordinates to the shape's mesh if its appearance needs them.
void OpenRTMapper::Impl::textured(Work& work, ItemId shape) {
  const Item& item = graph.items[shape];
  const TextureNeed need = textureNeed(static_cast<nodes::Shape&>(*item.node).appearance.get());
  if (!graph.meshes.require(item.mesh, need)) return;
  work.meshes.push_back(item.mesh);
  work.regroup = true; // it no longer equals meshes without texture coordinates
}

// Handles a change of a light or a LocalFog.
void OpenRTMapper::Impl::switchChanged(Work& work, Node& node) {
  const ItemId id = graph.find(&node);
  // The headlight of a NavigationInfo is read every frame.
  if (id == 0 || !isSwitched(graph.items[id].kind)) return;
  const bool scoped = graph.items[id].scoped;
  graph.readSwitch(id);
  lights.changed(node);
  fogs.changed(node);
  environment.changed(node);
  if (graph.items[id].on && !graph.items[id].placeDependent) work.regroup = true;
  if (graph.items[id].scoped != scoped) work.regroup = true;
}

void OpenRTMapper::Impl::regroup() {
  ++regroupings;
  graph.settle();
  const std::vector<ItemId> changed = summarise(graph, world.diagnostics);
  const auto inPlaces = [&](ItemId id) {
    bool any = graph.items[id].placeDependent;
    places.each(id, [&](int32_t) { any = true; });
    return any;
  };
  std::vector<Place> gone;
  if (std::any_of(changed.begin(), changed.end(), inPlaces) ||
      std::any_of(graph.replanned().begin(), graph.replanned().end(), inPlaces)) {
    places.build(graph, gone);
    places.updateForFrame(graph, camera);
  }
  objects.contentChanged(graph.replanned());
  objects.contentChanged(changed);
  objects.placingChanged(changed);
  objects.regrouped(gone);
  lights.remove(gone);
  fogs.remove(gone);
  lights.forget(graph);
  rebind();
  viewsStale = boundsStale = namesStale = lightStale = true;
  countsStale = false;
  if (surfaces.count() <= 2 * surfacesKept_) return;
  std::unordered_set<const Node*> used;
  for (const ItemId id : graph.order)
    if (const Item& item = graph.items[id]; item.kind == Kind::shape)
      used.insert(renderedNode(static_cast<nodes::Shape&>(*item.node).appearance.get()));
  surfaces.forgetUnless([&](const Node* appearance) { return used.contains(appearance); });
  surfacesKept_ = std::max<size_t>(64, surfaces.count());
}

} // namespace xvrml
