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
    for (ItemId id = 1; id < graph_.items.size(); ++id)
      if (graph_.items[id].shared) boxes_[id] = below({id, none, Matrix()});
    return below({graph_.root, 0, Matrix()});
  }

 private:
  Bounds below(const Step& first) {
    Bounds bounds;
    std::vector<Step> open{first};
    bool top = true;
    while (!open.empty()) {
      const Step step = open.back();
      open.pop_back();
      const Item& item = graph_.items[step.item];
      if (item.shared && !top) {
        growByBox(bounds, boxes_[step.item], step.matrix);
        continue;
      }
      top = false;
      Matrix inside = item.matrix == none ? step.matrix : compose(step.matrix, graph_.matrixOf(item));
      if (step.place != none) inside = compose(inside, places_.turns[size_t(step.place)]);
      if (item.kind == Kind::shape) graph_.meshes.grow(bounds, item.mesh, inside);
      const uint32_t count = item.kind == Kind::lod ? std::min(item.childCount, 1u) : item.childCount;
      for (uint32_t c = 0; c < count; ++c) {
        const int32_t at = step.place == none ? none : places_.children[places_.all[size_t(step.place)].firstChild + c];
        open.push_back({graph_.begin(item)[c], at, inside});
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
