// summary.cpp: counts what each item of the render graph holds and decides what becomes an object
// of its own. Called by the mapper when the world has been read and when something of it is grouped
// anew.
//
// An item has an object of its own when events reach it (xvrml/change.h) or it is an Inline that is
// still to be loaded, when an author wants it (ORTInstance, ORTStatic), or when it is shared:
// reached several times, and
//  - its content does not depend on the place: no lights, bindables, billboards or LODs below it
//  (such an item has an object
//    a place: see places.cpp);
//  - it holds no lines and points, whose width is a matter of the place, unless there would be very
//  many of them;
//  - it is worth instances (cost.h).
// Everything else is written into the object above: static geometry ends in few large objects.
// Decisions follow from the world as it stands and what reaches it, never from what was mapped
// before.
#include <algorithm>

#include "mapper/graph/graph.h"
#include "xvrml/change.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

constexpr uint64_t manyLines = 100'000;
constexpr uint64_t placeLimit = 200'000;

bool reachedBy(const Item& item, Change kind) { return item.node && reaches(*item.node, kind); }

// A geometry node, or one that it holds: Coordinate, Color, FontStyle ...
bool geometryReached(Node& geometry) {
  if (!geometry.live) return false;
  if (reaches(geometry, Change::geometry)) return true;
  for (const FieldInfo& field : geometry.type().fields) {
    if (field.type != FieldType::SFNode ||
        (field.access != Access::field && field.access != Access::exposedField))
      continue;
    const Node* held = renderedNode(static_cast<NodeRef*>(geometry.storage(field))->get());
    if (held && reaches(*held, Change::geometry)) return true;
  }
  return false;
}

// The colour of lines without colours of their own is the Material's.
bool lineColorReached(Node* shape) {
  if (!shape->live) return false;
  Node* node = renderedNode(static_cast<nodes::Shape*>(shape)->appearance.get());
  if (reaches(*shape, Change::appearance) || (node && reaches(*node, Change::appearance)))
    return true;
  const auto* appearance = nodeCast<nodes::Appearance>(node);
  const Node* material = appearance ? renderedNode(appearance->material.get()) : nullptr;
  return material && reaches(*material, Change::appearance);
}

bool drawsLines(const Node& geometry) {
  return geometry.type().index == nodes::IndexedLineSet::typeIndex ||
         geometry.type().index == nodes::PointSet::typeIndex;
}

class Summary {
 public:
  explicit Summary(Graph& graph) : graph_(graph), paths_(graph.items.size(), 0) {}

  std::vector<ItemId> run(Diagnostics& diagnostics) {
    countPaths();
    countUpwards(false);
    if (graph_.items[Graph::root].places > placeLimit) {
      diagnostics.warn({},
                       "lights, viewpoints, billboards and levels of detail appear at more than " +
                           std::to_string(placeLimit) +
                           " places: those in groups that are used several times are left out");
      countUpwards(true);
    }
    decideSharing();
    std::vector<ItemId> changed;
    for (const ItemId id : graph_.order) {
      Item& item = graph_.items[id];
      const uint64_t decisions = decisionsOf(item);
      if (item.decisions != decisions) changed.push_back(id);
      item.decisions = decisions;
    }
    return changed;
  }

 private:
  // What an object's content, or the way it is placed, depends on.
  uint64_t decisionsOf(const Item& item) const {
    const bool flags[] = {item.placed,  item.scopesLight, item.moves,
                          item.changes, item.recolored,   item.viaMesh};
    uint64_t bits = uint64_t(item.own);
    for (const bool flag : flags) bits = bits << 1 | uint64_t(flag);
    const int32_t mesh = item.viaMesh ? graph_.meshes.equal(item.mesh) : none;
    return bits << 33 | uint64_t(mesh + 1) << 1 | 1; // an item that was never looked at has 0
  }

  // On how many ways each item is reached; whether an ORTStatic lies on all of them.
  void countPaths() {
    for (const ItemId id : graph_.order) graph_.items[id].merged = id != Graph::root;
    paths_[Graph::root] = 1;
    for (size_t i = graph_.order.size(); i-- > 0;) {
      const Item& item = graph_.items[graph_.order[i]];
      const bool merges = item.hint == Hint::merge || (item.hint == Hint::none && item.merged);
      for (const ItemId child : item.children) {
        paths_[child] = addSaturating(paths_[child], paths_[graph_.order[i]]);
        graph_.items[child].merged &= merges;
      }
    }
    graph_.items[0].merged = false;
  }

  void lookAtShape(Item& item) {
    Node& geometry = graph_.meshes.geometry(item.mesh);
    const bool reached = graph_.meshes.dynamic(item.mesh) && !item.merged;
    const bool lines = drawsLines(geometry);
    const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
    item.shapes = 1;
    item.triangles = extent.kind == Mesh::Kind::triangles ? extent.primitives : 0;
    item.lines = lines || extent.kind == Mesh::Kind::lines || extent.kind == Mesh::Kind::points;
    item.draws = true;
    item.recolored = !lines && !item.merged && reachedBy(item, Change::appearance);
    if (lines && reached) item.own = Own::geometry;
    if (lines && !item.merged && lineColorReached(item.node.get())) item.own = Own::appearance;
    item.viaMesh = !lines && (reached || item.recolored);
    item.changes = isSplit(item.own);
    item.primitives =
        item.viaMesh ? 1 : std::max<uint64_t>(1, extent.primitives); // nothing is for nothing
  }

  void lookAtHints(Item& item) {
    item.moves = !item.merged && reachedBy(item, Change::transform);
    const bool changes = !item.merged && (item.awaited || reachedBy(item, Change::children));
    item.changes |= changes;
    item.draws |= changes;
    if (!item.draws) return;
    if (changes) item.own = Own::children;
    if (item.moves) item.own = Own::transform;
    if (item.hint == Hint::instantiate) item.own = Own::wanted;
    if (item.hint == Hint::merge && !item.merged) item.own = Own::merged;
  }

  static bool shines(const Item& item) {
    return isLight(item.kind) && (item.on || reachedBy(item, Change::light));
  }

  static bool placedByItself(const Item& item) {
    if (item.kind == Kind::billboard || item.kind == Kind::lod) return item.draws;
    return isBindable(item.kind) || shines(item);
  }

  // Children stand before parents: one pass. strip: items reached on several ways lose what is
  // placed in them.
  void countUpwards(bool strip) {
    std::vector<uint8_t> reached(graph_.meshes.size());
    for (const ItemId id : graph_.order)
      if (const Item& item = graph_.items[id];
          item.mesh != none && !item.merged && geometryReached(graph_.meshes.geometry(item.mesh)))
        reached[size_t(item.mesh)] = 1;
    for (size_t mesh = 0; mesh < reached.size(); ++mesh)
      graph_.meshes.setDynamic(int32_t(mesh), reached[mesh]);
    for (const ItemId id : graph_.order) countItem(id, strip);
  }

  void countItem(ItemId id, bool strip) {
    Item& item = graph_.items[id];
    item.placed = item.draws = item.scopesLight = item.lines = item.viaMesh = item.recolored =
        item.changes = false;
    item.own = Own::none;
    item.primitives = item.triangles = item.shapes = item.places = 0;
    if (item.kind == Kind::shape) lookAtShape(item);
    for (size_t c = 0; c < item.children.size(); ++c) {
      // The highest level of detail stands for all of them: only one is drawn.
      const Item& child = graph_.items[item.children[c]];
      const bool counts = item.kind != Kind::lod || c == 0;
      item.places = addSaturating(item.places, child.places);
      item.placed |= child.placed;
      item.draws |= child.draws;
      item.lines |= child.lines;
      item.scopesLight |= child.placed && child.kind == Kind::directionalLight;
      if (!counts) continue;
      item.primitives = addSaturating(item.primitives, isSplit(child.own) ? 1 : child.primitives);
      item.triangles = addSaturating(item.triangles, child.triangles);
      item.shapes = addSaturating(item.shapes, child.shapes);
    }
    lookAtHints(item);
    item.placed |= placedByItself(item);
    // What events may put into it may have to be placed: decided now, so that the groups above stay
    // as they are then.
    item.placed |= item.changes && !nodeCast<nodes::Shape>(item.node) && paths_[id] == 1;
    if (item.placed)
      item.places =
          addSaturating(item.places, item.kind == Kind::lod ? 1 + item.children.size() : 1);
    if (strip && paths_[id] > 1 && item.placed) {
      item.placed = item.scopesLight = false;
      item.places = 0;
    }
  }

  // Parents stand behind children: going backwards, the number of times an item would be written is
  // known when it is met.
  void decideSharing() {
    std::vector<uint64_t> written(graph_.items.size(), 0);
    written[Graph::root] = 1;
    for (size_t i = graph_.order.size(); i-- > 0;) {
      const ItemId id = graph_.order[i];
      Item& item = graph_.items[id];
      const uint64_t times = written[id];
      if (item.own == Own::none && !item.placed && item.parentCount > 1) {
        const bool linesAllow =
            !item.lines || multiplySaturating(item.primitives, times) > manyLines;
        if (linesAllow && worthInstances(item.primitives, times, item.merged))
          item.own = Own::shared;
      }
      if (item.kind == Kind::shape && !item.lines && !item.viaMesh) item.viaMesh = sharesMesh(item);
      const uint64_t own = item.own != Own::none && !item.placed ? 1 : times;
      for (const ItemId child : item.children) written[child] = addSaturating(written[child], own);
    }
  }

  bool sharesMesh(const Item& item) {
    const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
    if (extent.kind != Mesh::Kind::triangles) return false;
    return graph_.meshes.dynamic(item.mesh) ||
           worthInstances(extent.primitives, graph_.meshes.users(item.mesh), item.merged);
  }

  Graph& graph_;
  std::vector<uint64_t> paths_;
};

} // namespace

void recount(Graph& graph) {
  for (const ItemId id : graph.order) {
    Item& item = graph.items[id];
    item.triangles = item.shapes = 0;
    if (item.kind == Kind::shape) {
      const Meshes::Extent extent = graph.meshes.extent(item.mesh);
      item.triangles = extent.kind == Mesh::Kind::triangles ? extent.primitives : 0;
      item.shapes = 1;
    }
    for (size_t c = 0; c < (item.kind == Kind::lod ? std::min<size_t>(1, item.children.size())
                                                   : item.children.size());
         ++c) {
      item.triangles = addSaturating(item.triangles, graph.items[item.children[c]].triangles);
      item.shapes = addSaturating(item.shapes, graph.items[item.children[c]].shapes);
    }
  }
}

std::vector<ItemId> summarise(Graph& graph, Diagnostics& diagnostics) {
  return Summary(graph).run(diagnostics);
}

} // namespace xvrml::mapper
