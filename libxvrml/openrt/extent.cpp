// extent.cpp: see extent.h. Shapes are measured by their vertices; a shared item once, its box then stands for it.
#include "openrt/extent.h"

#include <algorithm>

namespace xvrml::mapping {
namespace {

struct Step {
  ItemId item;
  int32_t place;
  Matrix matrix;
};

class Measure {
 public:
  Measure(Graph& graph, const Places& places) : graph_(graph), places_(places), boxes_(graph.items.size()) {}

  Bounds all() {
    // Children stand before parents, so a shared item's shared parts have been measured when it is met.
    for (const ItemId id : graph_.order)
      if (shared(id)) boxes_[id] = below({id, none, Matrix()});
    return below({Graph::root, 0, Matrix()});
  }

 private:
  bool shared(ItemId id) const {
    const Item& item = graph_.items[id];
    return item.own != Own::none && !item.placed && item.parentCount > 1;
  }

  // Of an item's content, without its own matrix.
  Bounds below(const Step& first) {
    Bounds bounds;
    std::vector<Step> open{first};
    while (!open.empty()) {
      const Step step = open.back();
      open.pop_back();
      const Item& item = graph_.items[step.item];
      if (item.kind == Kind::shape) graph_.meshes.grow(bounds, item.mesh, step.matrix);
      const size_t count = item.kind == Kind::lod ? std::min(item.children.size(), size_t(1)) : item.children.size();
      for (size_t c = 0; c < count; ++c) {
        const ItemId child = item.children[c];
        if (!graph_.items[child].draws) continue;
        const int32_t at = step.place == none ? none : places_.children[places_.all[size_t(step.place)].firstChild + c];
        const Matrix inside = graph_.below(step.matrix, graph_.items[child]);
        if (at == none && shared(child))
          growByBox(bounds, boxes_[child], inside);
        else
          open.push_back({child, at, at == none ? inside : compose(inside, places_.turns[size_t(at)])});
      }
    }
    return bounds;
  }

  Graph& graph_;
  const Places& places_;
  std::vector<Bounds> boxes_;
};

} // namespace

Bounds boundsOf(Graph& graph, const Places& places) { return Measure(graph, places).all(); }

} // namespace xvrml::mapping
