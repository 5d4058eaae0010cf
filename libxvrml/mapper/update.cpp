// update.cpp: from changed fields to the least that has to be done, by their kind of change. Called
// by the mapper between frames, on its thread.
//
// What events were known to reach has been kept apart when the world was grouped (summary.cpp), so
// a change touches instances, one object or a shader's parameters. What nothing was known to reach
// is part of something larger: the first change of it regroups (the engine now says that it is
// reached), later ones are cheap.
#include <algorithm>
#include <unordered_set>

#include "mapper/mapper_impl.h"
#include "xvrml/change.h"

namespace xvrml {

using namespace mapper;

struct OpenRTMapper::Impl::Work {
  bool regroup = false;
  std::vector<ItemId> rewrite;             // what these items hold is drawn otherwise
  std::vector<ItemId> replace;             // these items are placed otherwise
  std::vector<int32_t> meshes;             // these meshes are others
  std::vector<Node*> appearances;          // with new properties, each once
  std::unordered_set<const Node*> visited; // by the walk upwards from appearance nodes
};

namespace {

bool isAppearance(const Node& node) {
  return node.type().index == nodes::Appearance::typeIndex ||
         node.type().index == nodes::ORTAppearance::typeIndex;
}

// Upwards through everything that is no group and no shape, prototype instances included: visit
// says where to go on.
template <class Visit>
void climb(Node& first, std::unordered_set<const Node*>& visited, const Visit& visit) {
  std::vector<Node*> open{&first};
  while (!open.empty()) {
    Node* node = open.back();
    open.pop_back();
    if (!visited.insert(node).second || !visit(*node)) continue;
    holdersOf(*node, open);
  }
}

// The shapes that hold a geometry or appearance node.
template <class Visit> void eachShape(const Graph& graph, Node& part, const Visit& visit) {
  std::unordered_set<const Node*> visited;
  climb(part, visited, [&](Node& node) {
    const ItemId item = graph.find(&node);
    if (item != 0 && graph.items[item].kind == Kind::shape) visit(item);
    return &node == &part || node.type().index < 0 || node.type().expand;
  });
}

} // namespace

void OpenRTMapper::Impl::update(const FieldChanges& changes) {
  Work work;
  work.regroup = graph.planRoots();
  for (const FieldChange& change : changes) {
    if (!change.node || !change.field) continue; // the roots: planRoots() has looked
    Node& node = *change.node;
    switch (change.field->change) {
    case Change::transform: transformed(work, node); break;
    case Change::geometry: reshaped(work, node); break;
    case Change::appearance:
    case Change::shader: relooked(work, node); break;
    case Change::light: relit(work, node); break;
    case Change::view:
      environment.changed(node);
      viewsStale = true;
      break;
    case Change::children:
      if (const ItemId item = graph.find(&node)) {
        graph.plan(item);
        work.regroup = true;
      }
      break;
    case Change::time:
    case Change::none: break;
    }
  }
  newSurfaces(work);
  if (work.regroup) regroup();
  for (const int32_t mesh : work.meshes) objects.meshChanged(mesh);
  std::erase_if(work.rewrite, [&](ItemId id) { return !graph.items[id].planned; });
  std::erase_if(work.replace, [&](ItemId id) { return !graph.items[id].planned; });
  if (!work.rewrite.empty()) objects.contentChanged(work.rewrite);
  if (!work.replace.empty()) objects.placingChanged(work.replace);
}

void OpenRTMapper::Impl::transformed(Work& work, Node& node) {
  const ItemId id = graph.find(&node);
  if (id == 0) return;
  viewsStale |= graph.items[id].placed;
  boundsStale = true;
  if (graph.items[id].kind == Kind::billboard) return; // turns with every frame
  if (!graph.readMatrix(id)) {
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

// A geometry node or one that it holds.
void OpenRTMapper::Impl::reshaped(Work& work, Node& first) {
  std::unordered_set<const Node*> visited;
  climb(first, visited, [&](Node& node) {
    const int32_t mesh = graph.meshes.find(&node);
    if (mesh == none) return node.type().index < 0 || !planOf(node.type());
    const bool expected = graph.meshes.dynamic(mesh);
    graph.meshes.changed(mesh);
    work.meshes.push_back(mesh);
    boundsStale = countsStale = true;
    eachShape(graph, node, [&](ItemId shape) {
      const Item& item = graph.items[shape];
      if (!expected && !item.merged) work.regroup = true;
      if (!expected || item.merged || item.own != Own::none || !item.viaMesh)
        work.rewrite.push_back(shape);
    });
    return false;
  });
}

// A Shape, an appearance or a node that it holds.
void OpenRTMapper::Impl::relooked(Work& work, Node& first) {
  if (const ItemId id = graph.find(&first)) {
    if (graph.items[id].kind != Kind::shape) return;
    lightStale = true; // its appearance may be this renderer's own
    if (objects.recolored(id)) return textured(work, id);
    textured(work, id);
    work.rewrite.push_back(id);
    work.regroup |= !graph.items[id].merged && graph.items[id].own != Own::appearance;
    return;
  }
  if (first.type().is("texture") && !textures.changed(first)) return; // the picture alone
  climb(first, work.visited, [&](Node& node) {
    if (node.type().index == nodes::ORTShader::typeIndex) custom.changed(node);
    if (node.type().index == nodes::ORTLight::typeIndex) lights.changed(node);
    environment.changed(node); // of an ORTBackground
    if (!isAppearance(node)) return node.type().index < 0 || !planOf(node.type());
    work.appearances.push_back(&node);
    return false;
  });
}

void OpenRTMapper::Impl::newSurfaces(Work& work) {
  for (Node* appearance : work.appearances) {
    const Surfaces::Effect effect = surfaces.update(*appearance);
    if (!effect.other && !effect.colored && !effect.textured) continue;
    eachShape(graph, *appearance, [&](ItemId shape) {
      const Item& item = graph.items[shape];
      if (effect.textured) textured(work, shape);
      if (item.lines) {
        if (!effect.colored) return;
        work.rewrite.push_back(shape);
        work.regroup |= !item.merged && item.own == Own::none;
      } else if (effect.other ? !objects.recolored(shape) : effect.textured && !item.viaMesh) {
        work.rewrite.push_back(shape);
      }
    });
  }
}

// The shape's mesh has texture coordinates from now on, if its appearance wants them.
void OpenRTMapper::Impl::textured(Work& work, ItemId shape) {
  const Item& item = graph.items[shape];
  if (!isTextured(static_cast<nodes::Shape&>(*item.node).appearance.get()) ||
      !graph.meshes.needTexture(item.mesh))
    return;
  work.meshes.push_back(item.mesh);
  work.regroup = true; // it is not equal any more to those without
}

void OpenRTMapper::Impl::relit(Work& work, Node& node) {
  const ItemId id = graph.find(&node);
  if (id == 0 || !isLight(graph.items[id].kind))
    return; // the headlight of a NavigationInfo is read with every frame
  graph.readLight(id);
  lights.changed(node);
  if (graph.items[id].on && !graph.items[id].placed) work.regroup = true;
}

void OpenRTMapper::Impl::regroup() {
  ++regroupings;
  graph.settle();
  const std::vector<ItemId> changed = summarise(graph, world.diagnostics);
  const auto inPlaces = [&](ItemId id) {
    bool any = graph.items[id].placed;
    places.each(id, [&](int32_t) { any = true; });
    return any;
  };
  std::vector<Place> gone;
  if (std::any_of(changed.begin(), changed.end(), inPlaces) ||
      std::any_of(graph.replanned().begin(), graph.replanned().end(), inPlaces)) {
    places.build(graph, gone);
    places.follow(graph, camera);
  }
  objects.contentChanged(graph.replanned());
  objects.contentChanged(changed);
  objects.placingChanged(changed);
  objects.regrouped(gone);
  lights.remove(gone);
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
