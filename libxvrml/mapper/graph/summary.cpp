// summary.cpp: counts the content of each item of the render graph and decides which items get an
// object of their own. Called by the mapper when the world has been read and on every regrouping.
//
// An item has an object of its own in these cases:
// * events reach it (xvrml/change.h), or it is an Inline that is still to be loaded;
// * the author wants it (ORTInstance, ORTStatic);
// * it has ClipPlanes: everything below it is written into its object, cut;
// * it is shared.
//
// An item is shared if it is reached several times and all of these hold:
// * its content does not depend on the place: no lights, bindables, billboards or LODs below it
//   (such an item has one object per place, see places.cpp);
// * it contains no lines or points, whose width depends on the place, unless there are very many of
//   them;
// * instances are worth their cost (cost.h).
//
// Everything else is written into the object above, so static geometry ends up in few large
// objects. Decisions depend only on the current world and on what events reach, never on what was
// mapped before.
#include <algorithm>

#include "geometry/half_space.h"
#include "mapper/graph/graph.h"
#include "xvrml/change.h"
#include "xvrml/nodes.h"
#include "xvrml/renderer.h"

namespace xvrml::mapper {
namespace {

constexpr uint64_t manyLines = 100'000;
constexpr uint64_t placeLimit = 200'000;

bool reachedBy(const Item& item, Change kind) { return item.node && reaches(*item.node, kind); }

// Returns whether events reach the Material that colours lines without colours of their own.
bool lineColorReached(Node* shape) {
  if (!shape->live) return false;
  const AppearanceParts parts =
      resolveAppearance(static_cast<nodes::Shape*>(shape)->appearance.get());
  for (const Node* node :
       {static_cast<const Node*>(shape), static_cast<const Node*>(parts.appearance),
        static_cast<const Node*>(parts.plain ? parts.material : nullptr)})
    if (node && reaches(*node, Change::appearance)) return true;
  return false;
}

class Summary {
 public:
  explicit Summary(Graph& graph) : graph_(graph), paths_(graph.items.size(), 0) {}

  std::vector<ItemId> run(Diagnostics& diagnostics) {
    countPaths();
    countUpwards(false);
    if (graph_.items[Graph::root].places > placeLimit) {
      diagnostics.warn({},
                       "lights, viewpoints, billboards, clip planes and levels of detail appear at "
                       "more than " +
                           std::to_string(placeLimit) +
                           " places: those in groups that are used several times are left out");
      countUpwards(true);
    }
    decideSharing();
    if (graph_.clips) warnOfManyClipPlanes(diagnostics);
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
  // Packs everything that an object's content or placement depends on.
  uint64_t decisionsOf(const Item& item) const {
    const bool flags[] = {item.placeDependent, item.scopes,  item.moves,  item.changes,
                          item.recolored,      item.viaMesh, item.clipped};
    uint64_t bits = uint64_t(item.objectReason);
    for (const bool flag : flags) bits = bits << 1 | uint64_t(flag);
    const int32_t mesh = item.viaMesh ? graph_.meshes.equal(item.mesh) : none;
    return bits << 33 | uint64_t(mesh + 1) << 1 | 1; // the last bit is set: a new item has 0
  }

  // Counts the paths to each item and computes whether an ORTStatic lies on all of them, or an item
  // that clips on any of them.
  void countPaths() {
    graph_.clips = false;
    for (const ItemId id : graph_.order) {
      Item& item = graph_.items[id];
      item.merged = id != Graph::root;
      item.clipped = false;
      item.clips = (item.kind == Kind::group || item.kind == Kind::billboard) &&
                   std::any_of(item.children.begin(), item.children.end(), [&](ItemId child) {
                     return graph_.items[child].kind == Kind::clipPlane;
                   });
      graph_.clips |= item.clips;
    }
    paths_[Graph::root] = 1;
    for (size_t i = graph_.order.size(); i-- > 0;) {
      Item& item = graph_.items[graph_.order[i]];
      item.merged |= item.clipped;
      const bool merges = item.hint == Hint::merge || (item.hint == Hint::none && item.merged);
      for (const ItemId child : item.children) {
        paths_[child] = addSaturating(paths_[child], paths_[graph_.order[i]]);
        graph_.items[child].merged &= merges;
        graph_.items[child].clipped |= item.clips || item.clipped;
      }
    }
    graph_.items[0].merged = graph_.items[0].clipped = false;
  }

  // Warns if more ClipPlanes apply to something than cut it.
  void warnOfManyClipPlanes(Diagnostics& diagnostics) const {
    std::vector<uint8_t> above(graph_.items.size(), 0); // by item: the most on any path
    for (size_t i = graph_.order.size(); i-- > 0;) {
      const Item& item = graph_.items[graph_.order[i]];
      size_t planes = above[graph_.order[i]];
      for (const ItemId child : item.children)
        if (item.clips && graph_.items[child].kind == Kind::clipPlane)
          planes +=
              halfSpaceOf(static_cast<nodes::ClipPlane&>(*graph_.items[child].node)).has_value();
      if (planes > maximumClipPlanes)
        return diagnostics.warn(item.node ? item.node->source : SourcePosition(),
                                "more than " + std::to_string(maximumClipPlanes) +
                                    " ClipPlanes apply to what is here: those after the first " +
                                    std::to_string(maximumClipPlanes) + " cut nothing away");
      for (const ItemId child : item.children)
        above[child] = std::max(above[child], uint8_t(planes));
    }
  }

  void summariseShape(Item& item) {
    Node& geometry = graph_.meshes.geometry(item.mesh);
    const bool reached = graph_.meshes.dynamic(item.mesh) && !item.merged;
    const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
    const bool lines = geometry.type().is("lines") || extent.thick ||
                       extent.kind == Mesh::Kind::lines || extent.kind == Mesh::Kind::points;
    item.shapes = 1;
    item.triangles = extent.kind == Mesh::Kind::triangles ? extent.primitives : 0;
    item.lines = lines;
    item.draws = true;
    item.recolored = !lines && !item.merged && reachedBy(item, Change::appearance);
    if (lines && reached) item.objectReason = ObjectReason::geometry;
    if (lines && !item.merged && lineColorReached(item.node.get()))
      item.objectReason = ObjectReason::appearance;
    item.viaMesh = !lines && (reached || item.recolored);
    item.changes = isSplit(item.objectReason);
    item.primitives =
        item.viaMesh ? 1 : std::max<uint64_t>(1, extent.primitives); // even empty geometry counts
  }

  void applyHints(Item& item) {
    item.moves = !item.merged && reachedBy(item, Change::transform);
    const bool changes = !item.merged && (item.awaited || reachedBy(item, Change::children));
    item.changes |= changes;
    item.draws |= changes;
    if (!item.draws) return;
    if (changes) item.objectReason = ObjectReason::children;
    if (item.moves) item.objectReason = ObjectReason::transform;
    if (item.hint == Hint::instantiate && !item.clipped) item.objectReason = ObjectReason::wanted;
    if (item.hint == Hint::merge && !item.merged) item.objectReason = ObjectReason::merged;
    if (item.clips) item.objectReason = ObjectReason::clipped;
  }

  static bool isOn(const Item& item) {
    return isSwitched(item.kind) && (item.on || reachedBy(item, Change::light));
  }

  static bool isPlaceDependent(const Item& item) {
    if (item.kind == Kind::billboard || item.kind == Kind::lod) return item.draws;
    return isBindable(item.kind) || item.kind == Kind::sensor || item.kind == Kind::clipPlane ||
           isOn(item);
  }

  // Counts bottom-up in one pass: children come before parents. strip: items with several paths
  // lose their place-dependent content.
  void countUpwards(bool strip) {
    std::vector<uint8_t> reached(graph_.meshes.size());
    for (const ItemId id : graph_.order)
      if (const Item& item = graph_.items[id];
          item.mesh != none && !item.merged &&
          reachBelow(graph_.meshes.geometry(item.mesh), Change::geometry))
        reached[size_t(item.mesh)] = 1;
    for (size_t mesh = 0; mesh < reached.size(); ++mesh)
      graph_.meshes.setDynamic(int32_t(mesh), reached[mesh]);
    for (const ItemId id : graph_.order) countItem(id, strip);
  }

  void countItem(ItemId id, bool strip) {
    Item& item = graph_.items[id];
    item.placeDependent = item.draws = item.scopes = item.holdsLights = item.lines = item.viaMesh =
        item.recolored = item.changes = false;
    item.objectReason = ObjectReason::none;
    item.primitives = item.triangles = item.shapes = item.places = 0;
    if (item.kind == Kind::shape) summariseShape(item);
    for (size_t c = 0; c < item.children.size(); ++c) {
      // The highest level of detail stands for all levels, because only one is drawn.
      const Item& child = graph_.items[item.children[c]];
      const bool counts = item.kind != Kind::lod || c == 0;
      item.places = addSaturating(item.places, child.places);
      item.placeDependent |= child.placeDependent;
      item.draws |= child.draws;
      item.lines |= child.lines;
      item.scopes |= child.placeDependent && isSwitched(child.kind) && child.scoped;
      item.holdsLights |=
          child.placeDependent && (isLight(child.kind) ? !child.scoped : child.holdsLights);
      if (!counts) continue;
      item.primitives =
          addSaturating(item.primitives, isSplit(child.objectReason) ? 1 : child.primitives);
      item.triangles = addSaturating(item.triangles, child.triangles);
      item.shapes = addSaturating(item.shapes, child.shapes);
    }
    item.scopes |= item.limitsLights && item.holdsLights;
    applyHints(item);
    item.placeDependent |= isPlaceDependent(item);
    // Events may later add place-dependent children. This is decided now, so that the groups above
    // can stay as they are then.
    item.placeDependent |= item.changes && !nodeCast<nodes::Shape>(item.node) && paths_[id] == 1;
    if (item.placeDependent)
      item.places =
          addSaturating(item.places, item.kind == Kind::lod ? 1 + item.children.size() : 1);
    if (strip && paths_[id] > 1 && item.placeDependent) {
      item.placeDependent = item.scopes = item.holdsLights = false;
      item.places = 0;
    }
  }

  // Decides sharing top-down. Going backwards, parents come before children, so the number of times
  // an item would be written is known when it is visited.
  void decideSharing() {
    std::vector<uint64_t> written(graph_.items.size(), 0);
    written[Graph::root] = 1;
    for (size_t i = graph_.order.size(); i-- > 0;) {
      const ItemId id = graph_.order[i];
      Item& item = graph_.items[id];
      const uint64_t times = written[id];
      if (item.objectReason == ObjectReason::none && !item.placeDependent && !item.clipped &&
          item.parentCount > 1) {
        const bool linesAllow =
            !item.lines || multiplySaturating(item.primitives, times) > manyLines;
        if (linesAllow && worthInstances(item.primitives, times, item.merged))
          item.objectReason = ObjectReason::shared;
      }
      if (item.kind == Kind::shape && !item.lines && !item.viaMesh && !item.clipped)
        item.viaMesh = sharesMesh(item);
      const uint64_t childTimes =
          item.objectReason != ObjectReason::none && !item.placeDependent ? 1 : times;
      for (const ItemId child : item.children)
        written[child] = addSaturating(written[child], childTimes);
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
