// extent.cpp: measures shapes by their vertices. A shared item is measured once; after that its box
// stands for it.
#include "mapper/extent.h"

#include <algorithm>
#include <cmath>

namespace xvrml::mapper {
namespace {

struct Step { // an item that is being measured
  ItemId item;
  int32_t place;
  Matrix matrix;
  size_t next = 0;    // number of children that were visited
  int32_t cut = none; // the nearest place at or above it that ClipPlanes cut
  Matrix toCut;       // matrix to the coordinates of that place's object
};

class Measure {
 public:
  Measure(Graph& graph, const Places& places)
      : graph_(graph), places_(places), boxes_(graph.items.size()) {}

  // Measures the shared items. Children come before parents, so the shared parts inside a shared
  // item have been measured already.
  void measureShared() {
    for (const ItemId id : graph_.order)
      if (shared(id)) boxes_[id] = below({id, none, Matrix()});
  }

  // Returns the bounds of the world. Call measureShared() before.
  Bounds all() { return below({Graph::root, 0, Matrix()}); }

  // Returns the points that lie farthest out. Call measureShared() before.
  std::vector<Vector> outermost(const Outermost::Directions& directions) {
    Outermost outermost(directions);
    outermost_ = &outermost;
    below({Graph::root, 0, Matrix()});
    return outermost.points();
  }

  // Returns the largest distance from a point. Call measureShared() before.
  double reach(const Vector& center) {
    center_ = &center;
    below({Graph::root, 0, Matrix()});
    return reach_;
  }

 private:
  bool shared(ItemId id) const {
    const Item& item = graph_.items[id];
    return item.objectReason != ObjectReason::none && !item.placeDependent && item.parentCount > 1;
  }

  // Returns the bounds of an item's content, without the item's own matrix.
  Bounds below(const Step& first) {
    Bounds bounds;
    std::vector<Step> open{first};
    if (first.place != none && !places_.all[size_t(first.place)].kept.empty())
      open[0].cut = first.place;
    while (!open.empty()) {
      Step& step = open.back();
      const Item& item = graph_.items[step.item];
      if (item.kind == Kind::shape) measureShape(bounds, item, step);
      const Range children = childrenOf(item, step.place);
      if (step.next >= children.end - children.begin) {
        open.pop_back();
        continue;
      }
      const size_t c = children.begin + step.next++;
      const ItemId child = item.children[c];
      if (!graph_.items[child].draws) continue;
      const int32_t at = step.place == none
                             ? none
                             : places_.children[places_.all[size_t(step.place)].firstChild + c];
      if (at == none && shared(child)) {
        growBy(bounds, boxes_[child], Graph::below(step.matrix, graph_.items[child]));
        continue;
      }
      const auto under = [&](const Matrix& outside) {
        const Matrix inner = Graph::below(outside, graph_.items[child]);
        return at == none ? inner : compose(inner, places_.billboardRotations[size_t(at)]);
      };
      Step below{child, at, under(step.matrix)};
      if (at != none && !places_.all[size_t(at)].kept.empty()) {
        below.cut = at;
      } else if (step.cut != none) {
        below.cut = step.cut;
        below.toCut = under(step.toCut);
      }
      open.push_back(below);
    }
    return bounds;
  }

  // Returns the children of an item to measure. An LOD has one, except for a sphere.
  struct Range {
    size_t begin, end;
  };
  Range childrenOf(const Item& item, int32_t place) const {
    const size_t count = item.children.size();
    if (item.kind != Kind::lod || center_ || count == 0) return {0, count};
    const int32_t chosen = place == none ? none : places_.all[size_t(place)].chosen;
    const size_t level = outermost_ && chosen != none ? size_t(chosen) : 0;
    return {level, level + 1};
  }

  void measureShape(Bounds& bounds, const Item& shape, const Step& step) {
    HalfSpaces kept;
    if (step.cut != none)
      for (const HalfSpace& halfSpace : places_.all[size_t(step.cut)].kept)
        kept.push_back(inside(halfSpace, step.toCut));
    if (outermost_)
      graph_.meshes.add(*outermost_, shape.mesh, step.matrix, kept);
    else if (center_)
      reach_ = std::max(reach_, graph_.meshes.reach(shape.mesh, step.matrix, *center_, kept));
    else
      graph_.meshes.grow(bounds, shape.mesh, step.matrix, kept);
  }

  void growBy(Bounds& bounds, const Bounds& box, const Matrix& matrix) {
    if (!center_ && !outermost_) return growByBox(bounds, box, matrix);
    for (int corner = 0; corner < 8 && !box.empty; ++corner) {
      auto side = [&](int axis) {
        return corner & (1 << axis) ? box.maximum[axis] : box.minimum[axis];
      };
      const Vector point = transformPoint(matrix, {side(0), side(1), side(2)});
      if (outermost_) {
        outermost_->add(point);
        continue;
      }
      const double far = (point - *center_).length();
      if (std::isfinite(far)) reach_ = std::max(reach_, far);
    }
  }

  Graph& graph_;
  const Places& places_;
  std::vector<Bounds> boxes_;
  // If set, points are collected there instead.
  Outermost* outermost_ = nullptr;
  // If set, distances from this point are measured instead of the bounds.
  const Vector* center_ = nullptr;
  double reach_ = 0;
};

} // namespace

Bounds boundsOf(Graph& graph, const Places& places) {
  Measure measure(graph, places);
  measure.measureShared();
  return measure.all();
}

BoundingSphere sphereOf(Graph& graph, const Places& places, const Bounds& bounds) {
  BoundingSphere sphere;
  if (bounds.empty) return sphere;
  for (int i = 0; i < 3; ++i)
    sphere.center[i] = bounds.minimum[i] + (bounds.maximum[i] - bounds.minimum[i]) / 2;
  Measure measure(graph, places);
  measure.measureShared();
  sphere.radius = measure.reach(Vector(sphere.center[0], sphere.center[1], sphere.center[2]));
  sphere.empty = false;
  return sphere;
}

std::vector<Vector> outermostPoints(Graph& graph, const Places& places,
                                    const Outermost::Directions& directions) {
  Measure measure(graph, places);
  measure.measureShared();
  return measure.outermost(directions);
}

} // namespace xvrml::mapper
