// objects.cpp: writes objects in an order that OpenRT accepts. An object must exist before another
// one instantiates it, and definitions do not nest. So places are written from last to first
// (children come after parents), items in the graph's postorder. The same order makes redefinition
// safe: the content of an object is up to date before it is written, so no object ever contains
// itself.
#include "mapper/graph/objects.h"

#include <algorithm>
#include <utility>

#include "xvrml/nodes.h"

namespace xvrml::mapper {

void Objects::updateForFrame() {
  defineDirty();
  for (size_t i = places_.all.size(); i-- > 0;) {
    Place& place = places_.all[i];
    if (!place.split || !place.active) continue;
    if (std::exchange(place.recut, false)) touch(place.part);
    const Kind kind = graph_.items[place.item].kind;
    if (kind == Kind::lod && graph_.items[place.item].placeDependent)
      chooseLevel(i);
    else if (place.part == none || parts_[size_t(place.part)].dirty)
      definePlace(i);
    if (kind == Kind::billboard && place.instance != 0) {
      const Matrix matrix = compose(graph_.below(place.base, graph_.items[place.item]),
                                    places_.billboardRotations[i]);
      rtInstanceMatrix(place.instance, data(placing(matrix)));
      report(world_.diagnostics, graph_.items[place.item].node->source, "Billboard");
    }
  }
  std::vector<Step>().swap(stack_); // it has held a step for every child of the largest group
  Place& root = places_.all[0];
  if (root.instance == 0) { // this part is the world itself
    rtLoadName(0);
    rtLoadIdentity();
    root.instance = rtInstantiateObject(parts_[size_t(root.part)].object);
    parts_[size_t(root.part)].instances = 1;
    ++instances_;
  }
}

// Rewrites dirty objects of items and meshes. Dirty objects of places are rewritten with their
// places.
void Objects::defineDirty() {
  std::vector<int32_t> items;
  for (const int32_t id : std::exchange(dirty_, {})) {
    const Part& part = parts_[size_t(id)];
    if (!part.dirty || !part.defined) continue;
    if (part.kind == Part::Kind::mesh) defineMesh(part.mesh);
    if (part.kind == Part::Kind::item) items.push_back(id);
  }
  std::sort(items.begin(), items.end(), [&](int32_t a, int32_t b) {
    return graph_.items[parts_[size_t(a)].item].position <
           graph_.items[parts_[size_t(b)].item].position;
  });
  for (const int32_t id : items) {
    const ItemId item = parts_[size_t(id)].item;
    defineBelow(item, none);
    defineItem(item);
  }
}

void Objects::definePlace(size_t index) {
  const int32_t part = partOfPlace(index);
  const Place place = places_.all[index];
  const Item& item = graph_.items[place.item];
  const bool pure = !item.placeDependent; // the place is a level of an LOD
  defineBelow(place.item, pure ? none : int32_t(index));
  open(part, item.changes && item.objectReason != ObjectReason::merged);
  kept_ = place.kept;
  expand({place.item, pure ? none : int32_t(index), Matrix()});
  drain();
  kept_.clear();
  close();
}

// Writes the object of an LOD. It holds one instance: the level in use.
void Objects::chooseLevel(size_t index) {
  const int32_t part = partOfPlace(index);
  Place& lod = places_.all[index];
  if (!parts_[size_t(part)].dirty && lod.drawn == lod.chosen) return;
  const auto levelAt = [&](int32_t level) -> Place* {
    const int32_t at = level == none || uint32_t(level) >= lod.childCount
                           ? none
                           : places_.children[lod.firstChild + size_t(level)];
    return at == none ? nullptr : &places_.all[size_t(at)];
  };
  if (Place* before = levelAt(lod.drawn)) before->instance = 0; // deleted with the old content
  clearContent(parts_[size_t(part)]);
  open(part, false);
  lod.drawn = lod.chosen;
  if (Place* level = levelAt(lod.chosen)) {
    const Matrix& turn = places_.billboardRotations[size_t(level - places_.all.data())];
    level->base = Matrix();
    level->instance = instantiate(
        level->part, compose(graph_.matrixOf(graph_.items[level->item]), turn), 0, live_);
  }
  close();
}

// Defines the missing objects of items and geometry that an item's content needs, at any depth.
void Objects::defineBelow(ItemId first, int32_t place) {
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
    const Item& item = graph_.items[visit.item];
    if (visit.place == none &&
        visit.item != first) { // the first item itself is being written by the caller
      if (std::exchange(definedBelow_[visit.item], 1)) continue;
      if (item.objectReason != ObjectReason::none) items.push_back(visit.item);
    }
    if (item.viaMesh) meshes.push_back(graph_.meshes.equal(item.mesh));
    for (size_t c = 0; c < item.children.size(); ++c) {
      const int32_t at = visit.place == none
                             ? none
                             : places_.children[places_.all[size_t(visit.place)].firstChild + c];
      if (at == none || !places_.all[size_t(at)].split) open.push_back({item.children[c], at});
    }
  }
  for (const int32_t mesh : meshes) defineMesh(mesh);
  std::sort(items.begin(), items.end(), [&](ItemId a, ItemId b) {
    return graph_.items[a].position < graph_.items[b].position;
  });
  for (const ItemId item : items) defineItem(item);
}

void Objects::defineItem(ItemId id) {
  const int32_t part = partOfItem(id);
  if (!parts_[size_t(part)].dirty) return;
  const Item& item = graph_.items[id];
  open(part, item.changes && item.objectReason != ObjectReason::merged);
  expand({id, none, Matrix()});
  drain();
  close();
}

void Objects::defineMesh(int32_t mesh) {
  const int32_t part = partOfMesh(mesh);
  if (!parts_[size_t(part)].dirty) return;
  open(part, graph_.meshes.dynamic(mesh));
  rtLoadName(0);
  rtLoadIdentity();
  const bool placed = !graph_.meshes.get(mesh).texPlaces.empty();
  const bool physical = graph_.meshes.takesPhysicalPlaces(mesh);
  if (draw(mesh, placed ? surfaces_.carrier(physical) : Surface(), true))
    parts_[size_t(part)].reach = graph_.meshes.extent(mesh).reach;
  close();
  report(world_.diagnostics, graph_.meshes.geometry(mesh).source,
         graph_.meshes.geometry(mesh).type().name);
}

void Objects::open(int32_t id, bool dynamic) {
  Part& part = parts_[size_t(id)];
  if (part.object == 0) {
    rtGenObjects(1, &part.object);
    ++objects_;
  }
  part.dynamic = dynamic && live_;
  writing_ = id;
  rtBeginObject(part.object);
}

// Redefinition makes an object dynamic, so the hint is set again: it must not depend on history.
void Objects::close() {
  rtEndObject();
  Part& part = parts_[size_t(writing_)];
  if (part.dynamic || part.defined)
    rtObjectHint(part.object, part.dynamic ? RT_DYNAMIC : RT_STATIC);
  part.defined = true;
  part.dirty = false;
  writing_ = none;
  ++definitions_;
}

} // namespace xvrml::mapper
