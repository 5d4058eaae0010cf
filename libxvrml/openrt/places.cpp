// places.cpp: see places.h. The walk has a stack of its own: nesting costs no C++ stack.
#include "openrt/places.h"

#include <algorithm>

#include "xvrml/nodes.h"

namespace xvrml::mapping {

Places::Places(const Graph& graph) {
  struct Open {
    uint32_t place, next;
  };
  std::vector<Open> stack;
  auto open = [&](ItemId id, int32_t parent, int32_t level) {
    const Item& item = graph.items[id];
    Place place;
    place.item = id;
    place.parent = parent;
    place.level = level;
    place.name = item.name != 0 || parent == none ? item.name : all[size_t(parent)].name;
    place.inlined = item.isInline || (parent != none && all[size_t(parent)].inlined);
    place.split = parent == none || level != none || item.kind == Kind::billboard || item.kind == Kind::lod || item.scopesLight;
    place.firstChild = uint32_t(children.size());
    children.resize(children.size() + item.childCount, none);
    all.push_back(place);
    stack.push_back({uint32_t(all.size() - 1), 0});
    return int32_t(all.size() - 1);
  };
  open(graph.root, none, none);
  while (!stack.empty()) {
    Open& top = stack.back();
    const Item& item = graph.items[all[top.place].item];
    if (top.next == item.childCount) {
      stack.pop_back();
      continue;
    }
    const uint32_t index = top.next++, slot = all[top.place].firstChild + index;
    const ItemId child = graph.begin(item)[index];
    const bool level = item.kind == Kind::lod;
    if (level || graph.items[child].placed) children[slot] = open(child, int32_t(top.place), level ? int32_t(index) : none);
  }
  turns.resize(all.size());
}

size_t Places::splitAbove(int32_t place) const {
  while (!all[size_t(place)].split) place = all[size_t(place)].parent;
  return size_t(place);
}

size_t levelOfDetail(const MFFloat& range, double distance, size_t count) {
  size_t level = 0;
  while (level < range.size() && distance >= range[level]) ++level;
  return std::min(level, count - 1); // too few levels: the last is used again
}

void Places::follow(const Graph& graph, const CameraSettings& camera) {
  const Matrix view = fromArray(camera.matrix);
  const Vector eye(view.x[3][0], view.x[3][1], view.x[3][2]), up(view.x[1][0], view.x[1][1], view.x[1][2]);
  for (size_t i = 0; i < all.size(); ++i) {
    Place& place = all[i];
    const Item& item = graph.items[place.item];
    const Matrix outside = place.parent == none ? Matrix() : all[size_t(place.parent)].world;
    place.active = place.parent == none || all[size_t(place.parent)].active;
    if (place.active && place.level != none) place.active = all[size_t(place.parent)].chosen == place.level;
    place.world = compose(outside, graph.matrixOf(item));
    Matrix toLocal;
    const bool local = invert(outside, toLocal);
    if (item.kind == Kind::billboard) {
      auto& billboard = static_cast<nodes::Billboard&>(*item.node);
      turns[i] =
          local ? billboardMatrix(vector(billboard.axisOfRotation), transformPoint(toLocal, eye), transformDirection(toLocal, up))
                : Matrix();
      place.world = compose(place.world, turns[i]);
    } else if (item.kind == Kind::lod) {
      auto& lod = static_cast<nodes::LOD&>(*item.node);
      const double distance = local ? (transformPoint(toLocal, eye) - vector(lod.center)).length() : 0;
      place.chosen = item.childCount == 0 ? none : int32_t(levelOfDetail(lod.range, distance, item.childCount));
    }
  }
}

} // namespace xvrml::mapping
