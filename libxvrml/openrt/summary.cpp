// summary.cpp: counts what each item of the render graph holds and decides what is shared. Called once, by the mapper.
//
// Rules of sharing. An item that is reached several times becomes an object of its own when
//  - its content does not depend on the place: no lights, bindables, billboards or LODs below it;
//  - it holds no lines and points, whose width is a matter of the place, unless there would be very many of them;
//  - it is worth an instance: at least `smallest` primitives, and at least `worth` primitives saved in all.
// What is not shared is written out again at each place; the first rule keeps that below `smallest` primitives a place.
#include <algorithm>

#include "openrt/graph.h"

namespace xvrml::mapping {
namespace {

constexpr uint64_t smallest = 32, worth = 2048, manyLines = 100'000;
constexpr uint64_t placeLimit = 200'000;

bool placedByItself(Kind kind) { return isLight(kind) || isBindable(kind) || kind == Kind::billboard || kind == Kind::lod; }

void countShape(Graph& graph, Item& item) {
  const Meshes::Extent extent = graph.meshes.extent(item.mesh);
  item.shapes = 1;
  item.primitives = extent.primitives;
  item.triangles = extent.kind == Mesh::Kind::triangles ? extent.primitives : 0;
  item.lines = extent.kind == Mesh::Kind::lines || extent.kind == Mesh::Kind::points;
}

// Children stand before parents: one pass. reached: how often each item is a child; multiply placed items lose what is placed
// in them if `strip`.
void countUpwards(Graph& graph, const std::vector<uint32_t>& reached, bool strip) {
  for (size_t i = 0; i < graph.items.size(); ++i) {
    Item& item = graph.items[i];
    item.placed = placedByItself(item.kind);
    item.places = !item.placed ? 0 : item.kind == Kind::lod ? 1 + uint64_t(item.childCount) : 1;
    item.scopesLight = item.lines = false;
    item.primitives = item.triangles = item.shapes = 0;
    if (item.kind == Kind::shape) countShape(graph, item);
    for (uint32_t c = 0; c < item.childCount; ++c) {
      // The highest level of detail stands for all of them: only one is drawn.
      const Item& child = graph.items[graph.begin(item)[c]];
      const bool counts = item.kind != Kind::lod || c == 0;
      item.places = addSaturating(item.places, child.places);
      item.placed |= child.placed;
      item.lines |= child.lines;
      item.scopesLight |= child.placed && child.kind == Kind::directionalLight;
      if (!counts) continue;
      item.primitives = addSaturating(item.primitives, child.primitives);
      item.triangles = addSaturating(item.triangles, child.triangles);
      item.shapes = addSaturating(item.shapes, child.shapes);
    }
    if (item.placed && !placedByItself(item.kind)) item.places = addSaturating(item.places, 1);
    if (strip && reached[i] > 1 && item.placed) {
      item.placed = item.scopesLight = false;
      item.places = 0;
    }
  }
}

// Parents stand behind children: going backwards, the number of times an item would be written is known when it is met.
void decideSharing(Graph& graph, const std::vector<uint32_t>& reached) {
  std::vector<uint64_t> written(graph.items.size(), 0);
  written[graph.root] = 1;
  for (size_t i = graph.items.size(); i-- > 1;) {
    Item& item = graph.items[i];
    const uint64_t times = written[i];
    const bool linesAllow = !item.lines || multiplySaturating(item.primitives, times) > manyLines;
    item.shared = reached[i] > 1 && times > 1 && !item.placed && linesAllow && item.primitives >= smallest &&
                  multiplySaturating(item.primitives, times - 1) >= worth;
    const uint64_t own = item.shared ? 1 : times;
    for (uint32_t c = 0; c < item.childCount; ++c) {
      uint64_t& child = written[graph.begin(item)[c]];
      child = addSaturating(child, own);
    }
  }
}

} // namespace

void summarise(Graph& graph, Diagnostics& diagnostics) {
  std::vector<uint32_t> reached(graph.items.size(), 0);
  for (const ItemId child : graph.children) ++reached[child];
  countUpwards(graph, reached, false);
  if (graph.items[graph.root].places > placeLimit) {
    diagnostics.warn({}, "lights, viewpoints, billboards and levels of detail appear at more than " + std::to_string(placeLimit) +
                             " places: those in groups that are used several times are left out");
    countUpwards(graph, reached, true);
  }
  decideSharing(graph, reached);
}

} // namespace xvrml::mapping
