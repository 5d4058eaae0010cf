// objects.cpp: the order in which objects are written. An object must exist before another instantiates it and definitions do
// not nest: places are written from the last to the first (children behind parents), shared items in the graph's postorder.
#include "openrt/objects.h"

#include <algorithm>

#include "xvrml/nodes.h"

namespace xvrml::mapping {

Objects::Objects(World& world, bool linearColor, Graph& graph, Places& places, Surfaces& surfaces)
    : world_(world), linear_(linearColor), graph_(graph), places_(places), surfaces_(surfaces),
      itemObjects_(graph.items.size(), 0), meshObjects_(graph.meshes.size(), 0), met_(graph.items.size(), 0) {}

void Objects::follow() {
  for (size_t i = places_.all.size(); i-- > 0;) {
    Place& place = places_.all[i];
    if (!place.split || !place.active) continue;
    const Kind kind = graph_.items[place.item].kind;
    if (kind == Kind::lod)
      chooseLevel(i);
    else if (!place.defined)
      definePlace(i);
    if (kind == Kind::billboard && place.instance != 0) {
      const Matrix matrix = compose(place.base, places_.turns[i]);
      if (!finite(matrix)) continue;
      rtInstanceMatrix(place.instance, data(matrix));
      report(world_.diagnostics, graph_.items[place.item].node->source, "Billboard");
    }
  }
  Place& root = places_.all[0];
  if (root.instance == 0) root.instance = instantiate(root.object, Matrix(), 0); // the world
}

void Objects::definePlace(size_t index) {
  const Place place = places_.all[index];
  const bool pure = !graph_.items[place.item].placed; // an LOD's level
  defineSharedBelow(place.item, pure ? none : int32_t(index));
  const RTid object = begin();
  if (pure)
    enter(place.item, none, Matrix(), place.name);
  else
    expand({place.item, int32_t(index), Matrix(), place.name});
  drain();
  rtEndObject();
  places_.all[index].object = object;
  places_.all[index].defined = true;
}

// The object of an LOD holds one instance: of the level that is in use.
void Objects::chooseLevel(size_t index) {
  Place& lod = places_.all[index];
  if (lod.object != 0 && lod.drawn == lod.chosen) return;
  const auto levelAt = [&](int32_t level) -> Place& {
    return places_.all[size_t(places_.children[lod.firstChild + size_t(level)])];
  };
  if (lod.drawn != none) levelAt(lod.drawn).instance = 0; // it goes with the old content
  lod.object = lod.object == 0 ? begin() : rtBeginObject(lod.object);
  lod.drawn = lod.chosen;
  if (lod.chosen != none) levelAt(lod.chosen).instance = instantiate(levelAt(lod.chosen).object, Matrix(), 0);
  rtEndObject();
}

// Shared items and geometry that an item's content needs, however deep, and that no object holds yet.
void Objects::defineSharedBelow(ItemId first, int32_t place) {
  struct Visit {
    ItemId item;
    int32_t place;
  };
  std::vector<ItemId> items;
  std::vector<int32_t> meshes;
  std::vector<Visit> open{{first, place}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    if (visit.place == none && met_[visit.item]) continue;
    if (visit.place == none) met_[visit.item] = 1;
    const Item& item = graph_.items[visit.item];
    if (item.shared && visit.place == none) items.push_back(visit.item);
    if (item.kind == Kind::shape && sharesGeometry(item.mesh)) meshes.push_back(item.mesh);
    for (uint32_t c = 0; c < item.childCount; ++c) {
      const int32_t at = visit.place == none ? none : places_.children[places_.all[size_t(visit.place)].firstChild + c];
      if (at == none || !places_.all[size_t(at)].split) open.push_back({graph_.begin(item)[c], at});
    }
  }
  for (const int32_t mesh : meshes) defineMesh(mesh);
  std::sort(items.begin(), items.end());
  for (const ItemId item : items) defineItem(item);
}

void Objects::defineItem(ItemId id) {
  if (itemObjects_[id] != 0) return;
  const uint32_t name = graph_.items[id].name;
  itemObjects_[id] = begin();
  inShared_ = true;
  expand({id, none, Matrix(), name});
  drain();
  inShared_ = false;
  rtEndObject();
}

void Objects::defineMesh(int32_t mesh) {
  if (meshObjects_[size_t(mesh)] != 0) return;
  meshObjects_[size_t(mesh)] = begin();
  rtLoadName(0);
  rtLoadIdentity();
  draw(mesh, Surface(), true);
  rtEndObject();
}

void Objects::enter(ItemId id, int32_t at, const Matrix& matrix, uint32_t name) {
  const Item& item = graph_.items[id];
  if (at != none && places_.all[size_t(at)].split) {
    Place& place = places_.all[size_t(at)];
    place.base = matrix;
    place.instance = instantiate(place.object, compose(matrix, places_.turns[size_t(at)]), givenName(item, name));
  } else if (at == none && item.shared) {
    instantiate(itemObjects_[id], matrix, givenName(item, name));
  } else {
    stack_.push_back({id, at, matrix, name});
  }
}

void Objects::expand(const Step& step) {
  const Item& item = graph_.items[step.item];
  const Matrix inside = item.matrix == none ? step.matrix : compose(step.matrix, graph_.matrixOf(item));
  const uint32_t name = item.name != 0 ? item.name : step.name;
  if (item.kind == Kind::shape) return writeShape(item, inside, name);
  const bool oneLevel = item.kind == Kind::lod; // one that has no place of its own: see summarise
  for (uint32_t c = oneLevel ? std::min(item.childCount, 1u) : item.childCount; c-- > 0;) {
    const int32_t at = step.place == none ? none : places_.children[places_.all[size_t(step.place)].firstChild + c];
    enter(graph_.begin(item)[c], at, inside, name);
  }
}

void Objects::drain() {
  while (!stack_.empty()) {
    const Step step = stack_.back();
    stack_.pop_back();
    expand(step);
  }
}

} // namespace xvrml::mapping
