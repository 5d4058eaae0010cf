// parts.cpp: the list of OpenRT objects, the ones that a change makes dirty, and the instances that
// events move. Part of class Objects.
#include <algorithm>

#include "mapper/graph/objects.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

Objects::Objects(World& world, bool linearColor, Graph& graph, Places& places, Surfaces& surfaces)
    : world_(world), linear_(linearColor), graph_(graph), places_(places), surfaces_(surfaces),
      quota_(world, "shapes") {
  for (const NodeRef& root : world.scope.roots) live_ |= root && root->live;
  definedBelow_.assign(graph.items.size(), 0);
}

int32_t Objects::newPart(Part::Kind kind) {
  int32_t id;
  if (freeParts_.empty()) {
    id = int32_t(parts_.size());
    parts_.emplace_back();
  } else {
    id = freeParts_.back();
    freeParts_.pop_back();
  }
  parts_[size_t(id)].kind = kind;
  return id;
}

void Objects::clearContent(Part& part) {
  const auto id = int32_t(&part - parts_.data());
  for (const int32_t used : part.uses)
    if (uint64_t& count = parts_[size_t(used)].instances; count > 0) --count;
  instances_ -= part.uses.size();
  part.uses.clear();
  std::sort(part.moving.begin(), part.moving.end());
  part.moving.erase(std::unique(part.moving.begin(), part.moving.end()), part.moving.end());
  for (const ItemId item : part.moving) {
    const auto found = trackedInstances_.find(item);
    if (found == trackedInstances_.end()) continue;
    std::erase_if(found->second, [id](const TrackedInstance& p) { return p.part == id; });
    if (found->second.empty()) trackedInstances_.erase(found);
  }
  part.moving.clear();
  part.shapes = part.triangles = part.primitives = part.drawCalls = 0;
  quota_.give(part.bytes);
  part.bytes = part.flattenedInstances = part.records = 0;
  part.reach = 0;
}

// The instances of a part vanish with it: the caller also removes the parts that hold them or marks
// them dirty.
void Objects::removePart(int32_t& id) {
  if (id == none) return;
  Part& part = parts_[size_t(id)];
  clearContent(part);
  if (part.object != 0) {
    rtDeleteObject(part.object);
    --objects_;
  }
  part = Part();
  freeParts_.push_back(id);
  id = none;
}

void Objects::clear() {
  for (const Part& part : parts_)
    if (part.object != 0) rtDeleteObject(part.object);
}

int32_t Objects::partOfItem(ItemId id) {
  int32_t& part = graph_.items[id].part;
  if (part == none) part = newPart(Part::Kind::item);
  parts_[size_t(part)].item = id;
  return part;
}

int32_t Objects::partOfPlace(size_t index) {
  Place& place = places_.all[index];
  if (place.part == none) place.part = newPart(Part::Kind::place);
  Part& part = parts_[size_t(place.part)];
  part.item = place.item;
  part.level = place.level;
  return place.part;
}

int32_t Objects::partOfMesh(int32_t mesh) {
  if (meshParts_.size() < graph_.meshes.size()) meshParts_.resize(graph_.meshes.size(), none);
  int32_t& part = meshParts_[size_t(mesh)];
  if (part == none) part = newPart(Part::Kind::mesh);
  parts_[size_t(part)].mesh = mesh;
  return part;
}

void Objects::touch(int32_t id) {
  if (id == none) return;
  Part& part = parts_[size_t(id)];
  if (part.dirty) return;
  part.dirty = true;
  clearContent(part);
  dirty_.push_back(id);
}

// Returns whether the item is reached other than as an LOD level. Levels are places.
bool Objects::instantiated(const Item& item) const {
  const auto first = graph_.parents.begin() + item.firstParent;
  return std::any_of(first, first + item.parentCount, [&](ItemId parent) {
    return graph_.items[parent].kind != Kind::lod || !graph_.items[parent].placeDependent;
  });
}

void Objects::regrouped(const std::vector<Place>& gone) {
  definedBelow_.assign(graph_.items.size(), 0);
  for (const ItemId id : graph_.dropped()) {
    removePart(graph_.items[id].part);
    trackedInstances_.erase(id);
  }
  for (Place place : gone) removePart(place.part);
  for (Place& place : places_.all)
    if (!place.split) {
      removePart(place.part);
      place.instance = 0;
    }
  for (const int32_t mesh : graph_.meshes.dropped())
    if (size_t(mesh) < meshParts_.size()) removePart(meshParts_[size_t(mesh)]);
  graph_.meshes.recycle();
  std::vector<uint8_t> needed(meshParts_.size());
  for (const ItemId id : graph_.order) {
    Item& item = graph_.items[id];
    if (item.part != none &&
        (item.objectReason == ObjectReason::none || item.placeDependent || !instantiated(item)))
      removePart(item.part);
    if (!item.viaMesh) continue;
    if (const auto mesh = size_t(graph_.meshes.equal(item.mesh)); mesh < needed.size())
      needed[mesh] = 1;
  }
  for (size_t mesh = 0; mesh < needed.size(); ++mesh)
    if (!needed[mesh]) removePart(meshParts_[mesh]);
}

// Walks up from the items to the objects that hold them, visiting each item once.
void Objects::contentChanged(const std::vector<ItemId>& items) {
  seen_.resize(graph_.items.size(), 0);
  ++walk_;
  std::vector<ItemId> open = items;
  while (!open.empty()) {
    const ItemId id = open.back();
    open.pop_back();
    if (seen_[id] == walk_) continue;
    seen_[id] = walk_;
    const Item& item = graph_.items[id];
    places_.each(id, [&](int32_t place) { touch(places_.all[places_.splitAbove(place)].part); });
    if (item.placeDependent) continue;
    if (item.objectReason != ObjectReason::none) {
      touch(item.part);
      continue;
    }
    for (uint32_t p = 0; p < item.parentCount; ++p) {
      const ItemId parent = graph_.parents[item.firstParent + p];
      if (graph_.items[parent].kind != Kind::lod || !graph_.items[parent].placeDependent)
        open.push_back(parent);
    }
  }
}

void Objects::placingChanged(const std::vector<ItemId>& items) {
  std::vector<ItemId> parents;
  for (const ItemId id : items) {
    const auto first = graph_.parents.begin() + graph_.items[id].firstParent;
    parents.insert(parents.end(), first, first + graph_.items[id].parentCount);
  }
  contentChanged(parents);
}

bool Objects::meshChanged(int32_t mesh) {
  if (size_t(mesh) >= meshParts_.size() || meshParts_[size_t(mesh)] == none) return false;
  touch(meshParts_[size_t(mesh)]);
  return true;
}

bool Objects::moved(ItemId id) {
  const Item& item = graph_.items[id];
  if (!item.moves || item.objectReason == ObjectReason::none) return false;
  const auto move = [&](RTid instance, const Matrix& matrix) {
    if (instance == 0) return;
    rtInstanceMatrix(instance, data(placing(matrix)));
    ++moves_;
  };
  if (const auto found = trackedInstances_.find(id);
      found != trackedInstances_.end() && !item.placeDependent)
    for (const TrackedInstance& p : found->second) move(p.instance, graph_.below(p.base, item));
  places_.each(id, [&](int32_t index) {
    const Place& place = places_.all[size_t(index)];
    if (place.split)
      move(place.instance,
           compose(graph_.below(place.base, item), places_.billboardRotations[size_t(index)]));
  });
  return true;
}

bool Objects::recolored(ItemId id) {
  const Item& item = graph_.items[id];
  if (!item.recolored || !item.viaMesh) return false;
  const auto found = trackedInstances_.find(id);
  if (found == trackedInstances_.end()) return true;
  Node* appearance = static_cast<nodes::Shape&>(*item.node).appearance.get();
  const RTid shader = surfaces_.surfaceFor(appearance, useOf(item)).shader;
  for (const TrackedInstance& p : found->second) rtInstanceShader(p.instance, shader);
  return true;
}

} // namespace xvrml::mapper
