// objects.cpp: the order in which objects are written. An object must exist before another
// instantiates it and definitions do not nest: places are written from the last to the first
// (children behind parents), items in the graph's postorder. The same order makes redefinition
// safe: what an object is about to hold has its new content already, so no object ever holds
// itself.
#include "mapper/graph/objects.h"

#include <algorithm>
#include <utility>

#include "xvrml/nodes.h"

namespace xvrml::mapper {

void Objects::follow() {
  defineDirty();
  for (size_t i = places_.all.size(); i-- > 0;) {
    Place& place = places_.all[i];
    if (!place.split || !place.active) continue;
    const Kind kind = graph_.items[place.item].kind;
    if (kind == Kind::lod && graph_.items[place.item].placed)
      chooseLevel(i);
    else if (place.part == none || parts_[size_t(place.part)].dirty)
      definePlace(i);
    if (kind == Kind::billboard && place.instance != 0) {
      const Matrix matrix =
          compose(graph_.below(place.base, graph_.items[place.item]), places_.turns[i]);
      if (!finite(matrix)) continue;
      rtInstanceMatrix(place.instance, data(matrix));
      report(world_.diagnostics, graph_.items[place.item].node->source, "Billboard");
    }
  }
  Place& root = places_.all[0];
  if (root.instance == 0) { // the world
    rtLoadName(0);
    rtLoadIdentity();
    root.instance = rtInstantiateObject(parts_[size_t(root.part)].object);
    parts_[size_t(root.part)].instances = 1;
    ++instances_;
  }
}

// Objects of items and meshes that were there before and are to be written again; those of places
// follow with their places.
void Objects::defineDirty() {
  std::vector<int32_t> items;
  for (const int32_t id : std::exchange(dirty_, {})) {
    const Part& part = parts_[size_t(id)];
    if (!part.dirty || !part.defined) continue;
    if (part.of == Part::Of::mesh) defineMesh(part.mesh);
    if (part.of == Part::Of::item) items.push_back(id);
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
  const bool pure = !item.placed; // an LOD's level
  defineBelow(place.item, pure ? none : int32_t(index));
  open(part, item.changes && item.own != Own::merged);
  expand({place.item, pure ? none : int32_t(index), Matrix()});
  drain();
  close();
}

// The object of an LOD holds one instance: of the level that is in use.
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
  if (Place* before = levelAt(lod.drawn)) before->instance = 0; // it goes with the old content
  forget(parts_[size_t(part)]);
  open(part, false);
  lod.drawn = lod.chosen;
  if (Place* level = levelAt(lod.chosen)) {
    const Matrix& turn = places_.turns[size_t(level - places_.all.data())];
    level->base = Matrix();
    level->instance = instantiate(
        level->part, compose(graph_.matrixOf(graph_.items[level->item]), turn), 0, live_);
  }
  close();
}

// Objects of items and geometry that an item's content needs, however deep, and that are not
// written yet.
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
        visit.item != first) { // the first is being written: only what is below is meant
      if (std::exchange(met_[visit.item], 1)) continue;
      if (item.own != Own::none) items.push_back(visit.item);
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
  open(part, item.changes && item.own != Own::merged);
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
  if (draw(mesh, Surface(), true)) parts_[size_t(part)].reach = graph_.meshes.extent(mesh).reach;
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

// Redefining makes an object dynamic by itself; how it is kept must not depend on what it was
// before.
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
