// places.cpp: expands the render graph into places. The walk uses an explicit stack, so nesting
// costs no C++ stack.
#include "mapper/graph/places.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "xvrml/nodes.h"

namespace xvrml::mapper {

void Places::build(const Graph& graph, std::vector<Place>& gone) {
  std::vector<Place> before = std::move(all);
  const std::vector<int32_t> childrenBefore = std::move(children);
  all.clear();
  children.clear();
  quota_.give(std::exchange(taken_, 0));
  expand(graph);
  billboardRotations.assign(all.size(), Matrix());
  inherit(before, childrenBefore, gone);
  index(graph.items.size());
}

void Places::expand(const Graph& graph) {
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
    place.inlined = item.isInline || (parent != none && all[size_t(parent)].inlined);
    place.split = parent == none || level != none || item.kind == Kind::billboard ||
                  item.kind == Kind::lod || item.scopes || isSplit(item.objectReason);
    place.limit = item.limitsLights && item.scopes ? int32_t(all.size())
                  : parent != none                 ? all[size_t(parent)].limit
                                                   : none;
    place.firstChild = uint32_t(children.size());
    place.childCount = uint32_t(item.children.size());
    children.resize(children.size() + item.children.size(), none);
    all.push_back(place);
    stack.push_back({uint32_t(all.size() - 1), 0});
    return int32_t(all.size() - 1);
  };
  open(Graph::root, none, none);
  while (!stack.empty()) {
    Open& top = stack.back();
    const Item& item = graph.items[all[top.place].item];
    if (top.next == item.children.size()) {
      stack.pop_back();
      continue;
    }
    const uint32_t index = top.next++, slot = all[top.place].firstChild + index;
    const ItemId child = item.children[index];
    const bool level = item.kind == Kind::lod && item.placeDependent;
    if (!level && !graph.items[child].placeDependent) continue;
    const Node* node = graph.items[child].node.get();
    if (!quota_.take(bytesOfPlace, node ? node->source : SourcePosition())) continue;
    taken_ += bytesOfPlace;
    children[slot] = open(child, int32_t(top.place), level ? int32_t(index) : none);
  }
}

// Matches previous and new places from the root down. A place is kept if its parent is kept and its
// item is still there.
void Places::inherit(std::vector<Place>& before, const std::vector<int32_t>& childrenBefore,
                     std::vector<Place>& gone) {
  std::vector<int32_t> match(all.size(), none); // by place: the previous place
  std::vector<uint8_t> isKept(before.size());
  const auto take = [&](size_t now, int32_t then) {
    Place &to = all[now], &from = before[size_t(then)];
    if (to.item != from.item) return false;
    match[now] = then;
    isKept[size_t(then)] = 1;
    to.drawn = from.drawn;
    to.part = from.part;
    to.instance = from.instance;
    to.base = from.base;
    to.kept = from.kept;
    to.recut = from.recut;
    to.light = from.light;
    to.lightScope = from.lightScope;
    to.lightMatrix = from.lightMatrix;
    to.fog = from.fog;
    to.fogScope = from.fogScope;
    to.fogMatrix = from.fogMatrix;
    return true;
  };
  if (!before.empty()) take(0, 0);
  for (size_t i = 0; i < all.size(); ++i) {
    if (match[i] == none) continue;
    const Place& then = before[size_t(match[i])];
    // Previous children by item; filled once the two lists get out of step.
    std::unordered_multimap<ItemId, int32_t> others;
    bool inStep = true;
    for (uint32_t c = 0, d = 0; c < all[i].childCount; ++c) {
      const int32_t now = children[all[i].firstChild + c];
      if (now == none) continue;
      const auto thenAt = [&](uint32_t slot) { return childrenBefore[then.firstChild + slot]; };
      while (inStep && d < then.childCount && thenAt(d) == none) ++d;
      if (inStep && d < then.childCount && take(size_t(now), thenAt(d++))) continue;
      if (inStep)
        for (uint32_t slot = then.childCount; slot-- > 0;)
          if (const int32_t old = thenAt(slot); old != none && !isKept[size_t(old)])
            others.emplace(before[size_t(old)].item, old);
      inStep = false;
      if (const auto found = others.find(all[size_t(now)].item); found != others.end()) {
        take(size_t(now), found->second);
        others.erase(found);
      }
    }
  }
  for (size_t i = 0; i < before.size(); ++i)
    if (!isKept[i]) gone.push_back(before[i]);
}

void Places::index(size_t items) {
  firstOf_.assign(items, none);
  nextOf_.assign(all.size(), none);
  for (size_t i = all.size(); i-- > 0;) {
    nextOf_[i] = firstOf_[all[i].item];
    firstOf_[all[i].item] = int32_t(i);
  }
}

size_t Places::splitAbove(int32_t place) const {
  while (!all[size_t(place)].split) place = all[size_t(place)].parent;
  return size_t(place);
}

size_t levelOfDetail(const MFFloat& range, double distance, size_t count) {
  size_t level = 0;
  while (level < range.size() && distance >= range[level]) ++level;
  return std::min(level, count - 1); // with too few levels the last one is used again
}

void Places::updateForFrame(const Graph& graph, const CameraSettings& camera) {
  const Matrix view = fromArray(camera.matrix);
  const Vector eye(view.x[3][0], view.x[3][1], view.x[3][2]),
      up(view.x[1][0], view.x[1][1], view.x[1][2]);
  for (size_t i = 0; i < all.size(); ++i) {
    Place& place = all[i];
    const Item& item = graph.items[place.item];
    const Matrix outside = place.parent == none ? Matrix() : all[size_t(place.parent)].world;
    place.active = place.parent == none || all[size_t(place.parent)].active;
    if (place.active && place.level != none)
      place.active = all[size_t(place.parent)].chosen == place.level;
    place.world = graph.below(outside, item);
    if (item.kind != Kind::billboard && item.kind != Kind::lod) continue;
    Matrix toLocal;
    const bool local = invert(outside, toLocal);
    if (item.kind == Kind::billboard) {
      auto& billboard = static_cast<nodes::Billboard&>(*item.node);
      billboardRotations[i] =
          local ? billboardMatrix(vector(billboard.axisOfRotation), transformPoint(toLocal, eye),
                                  transformDirection(toLocal, up))
                : Matrix();
      place.world = compose(place.world, billboardRotations[i]);
    } else {
      auto& lod = static_cast<nodes::LOD&>(*item.node);
      const double distance =
          local ? (transformPoint(toLocal, eye) - vector(lod.center)).length() : 0;
      place.chosen = item.children.empty()
                         ? none
                         : int32_t(levelOfDetail(lod.range, distance, item.children.size()));
    }
  }
  updateHalfSpaces(graph);
}

// Comparing what is left with what was left before finds every cause of a new cut: events to a
// ClipPlane or to a Transform between it and the object, and Billboards that turn.
void Places::updateHalfSpaces(const Graph& graph) {
  const bool clipped = std::exchange(clips_, graph.clips);
  if (!clipped && !clips_) return;
  // By place: the matrix to the coordinates of the nearest object at or above it.
  std::vector<Matrix> toObject(all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    Place& place = all[i];
    const Item& item = graph.items[place.item];
    if (place.parent != none)
      toObject[i] = compose(toObject[size_t(place.parent)],
                            compose(graph.below(Matrix(), item), billboardRotations[i]));
    if (!place.split) continue;
    HalfSpaces kept;
    if (place.parent != none)
      for (const HalfSpace& outside : all[splitAbove(place.parent)].kept)
        kept.push_back(inside(outside, toObject[i]));
    for (const ItemId child : item.children) {
      if (!item.clips || graph.items[child].kind != Kind::clipPlane) continue;
      const auto left = halfSpaceOf(static_cast<nodes::ClipPlane&>(*graph.items[child].node));
      if (left && kept.size() < maximumClipPlanes) kept.push_back(*left);
    }
    toObject[i] = Matrix();
    if (kept == place.kept) continue;
    place.kept = std::move(kept);
    place.recut = true;
  }
}

} // namespace xvrml::mapper
