// view_history.cpp: An object that is defined again loses its instances and gets new ones, although
// most of them are often the same for the user. So instances and geometries of such an object are
// matched with those of before: by name (rtLoadName), instances also by the object that they
// place, and in order if there are several. If their number has changed, none of them match.
#include "scene/view_history.h"

#include <algorithm>
#include <compare>

namespace openrt {
namespace {

// Returns whether a hit's primitive and its barycentric coordinates mean the same point of both.
bool sameTopology(const Geometry& a, const Geometry& b) {
  if (a.primitive != b.primitive) return false;
  if (a.primitive == edit::Primitive::Sphere) return true;
  if (a.surface || b.surface) return a.surface && b.surface && *a.surface == *b.surface;
  return a.points && b.points && a.points->size() == b.points->size() &&
         sameBytes(a.indices, b.indices);
}

// Two sorted lists are matched group by group. Calls f(a, b) for the elements of the groups that
// have the same size in both, in order. A group has equal keys.
template <class T, class Key, class F>
void matchGroups(const std::vector<T>& a, const std::vector<T>& b, const Key& key, const F& f) {
  const auto groupEnd = [&](const std::vector<T>& list, size_t from) {
    size_t end = from;
    while (end < list.size() && key(list[end]) == key(list[from])) end++;
    return end;
  };
  for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const size_t iEnd = groupEnd(a, i), jEnd = groupEnd(b, j);
    if (key(a[i]) == key(b[j])) {
      if (iEnd - i == jEnd - j)
        for (size_t k = 0; i + k < iEnd; k++) f(a[i + k], b[j + k]);
      i = iEnd;
      j = jEnd;
    } else if (key(a[i]) < key(b[j])) {
      i = iEnd;
    } else {
      j = jEnd;
    }
  }
}

} // namespace

void ViewHistory::forget() {
  instances_.clear();
  newInstances_.clear();
  newObjects_.clear();
  replaced_.clear();
  objects_.clear();
}

void ViewHistory::beginAnew() {
  forget();
  beginning_ = false;
}

void ViewHistory::changeInstance(uint32_t id, const Instance& before) {
  if (!beginning_ && !newInstances_.contains(id)) instances_.try_emplace(id, before);
}

void ViewHistory::addInstance(uint32_t id) {
  if (!beginning_) newInstances_.insert(id);
}

void ViewHistory::changeObject(uint32_t id, const FormerGeometries& before) {
  if (!beginning_ && !newObjects_.contains(id)) objects_.try_emplace(id, Past{before, {}});
}

void ViewHistory::addObject(uint32_t id) {
  if (!beginning_) newObjects_.insert(id);
}

void ViewHistory::match(const Scene& scene) {
  if (objects_.empty()) return;
  matchInstances(scene);
  for (auto& [id, past] : objects_) {
    const auto now = scene.objects.find(id);
    past.matches.clear();
    if (now != scene.objects.end()) matchGeometries(past, now->second.geometries);
  }
}

void ViewHistory::matchInstances(const Scene& scene) {
  struct Child {
    uint32_t parent, object, name, id;
    auto operator<=>(const Child&) const = default;
  };
  std::vector<Child> gone, fresh;
  for (const auto& [id, before] : instances_)
    if (objects_.contains(before.parent) && !scene.instances.contains(id))
      gone.push_back({before.parent, before.object, before.name, id});
  for (const uint32_t id : newInstances_) {
    const auto found = scene.instances.find(id);
    if (found == scene.instances.end() || !objects_.contains(found->second.parent)) continue;
    const Instance& now = found->second;
    fresh.push_back({now.parent, now.object, now.name, id});
  }
  std::sort(gone.begin(), gone.end());
  std::sort(fresh.begin(), fresh.end());
  replaced_.clear();
  matchGroups(
      gone, fresh,
      [](const Child& c) {
        return Child{c.parent, c.object, c.name, 0};
      },
      [&](const Child& was, const Child& is) { replaced_[is.id] = was.id; });
}

void ViewHistory::matchGeometries(Past& past, const std::vector<Geometry>& now) {
  struct Named {
    uint32_t name, index;
    auto operator<=>(const Named&) const = default;
  };
  const auto sorted = [](const std::vector<Geometry>& list) {
    std::vector<Named> names;
    for (size_t i = 0; i < list.size(); i++) names.push_back({list[i].name, uint32_t(i)});
    std::sort(names.begin(), names.end());
    return names;
  };
  past.matches.assign(now.size(), nullptr);
  matchGroups(
      sorted(*past.geometries), sorted(now), [](const Named& n) { return n.name; },
      [&](const Named& was, const Named& is) {
        const Geometry& before = (*past.geometries)[was.index];
        if (sameTopology(before, now[is.index])) past.matches[is.index] = &before;
      });
}

const Instance* ViewHistory::before(uint32_t instance) const {
  const auto replaced = replaced_.find(instance);
  const auto found = instances_.find(replaced == replaced_.end() ? instance : replaced->second);
  return found != instances_.end() && found->second.visible ? &found->second : nullptr;
}

const Geometry* ViewHistory::before(uint32_t object, size_t geometry) const {
  const auto found = objects_.find(object);
  return found != objects_.end() && geometry < found->second.matches.size()
             ? found->second.matches[geometry]
             : nullptr;
}

} // namespace openrt
