// flatten.cpp: walks the instances depth first with an explicit stack, so that nesting depth costs
// no call stack. Subtrees without geometry are pruned: a doubling tower of empty objects costs
// nothing.
#include "scene/flatten.h"

#include <algorithm>
#include <unordered_map>

namespace openrt {
namespace {

class Flattener {
 public:
  Flattener(const Scene& scene, bool paths) : scene_(scene), paths_(paths) {
    if (paths) result_.paths.emplace_back();
    for (const auto& [id, light] : scene.lights)
      if (light.scope) scoped_[light.scope].push_back(id);
    result_.lightSet(unscopedLights(scene));
  }

  Flattened run() {
    partOf(0);
    for (size_t part = 0; part < result_.parts.size() && !result_.truncated; part++)
      walk(uint32_t(part));
    placeAll();
    return std::move(result_);
  }

 private:
  struct Frame { // an object being walked and the attributes its path inherits
    uint32_t object = 0;
    Inherited path;
    Matrix4d matrix;
    uint32_t step = 0; // index into Flattened::paths
    size_t next = 0;   // child to visit
  };

  // Returns true if an object or anything below it has geometry. Computed once per object, without
  // recursion.
  bool drawable(uint32_t root) {
    enum : uint8_t { unknown, open, no, yes };
    std::vector<uint32_t> todo{root};
    while (!todo.empty()) {
      const uint32_t id = todo.back();
      uint8_t& state = drawable_[id];
      if (state == no || state == yes) {
        todo.pop_back();
        continue;
      }
      const auto object = scene_.objects.find(id);
      bool result = object != scene_.objects.end() && !object->second.geometries.empty();
      bool wait = false;
      for (uint32_t child : scene_.childrenOf(id)) {
        if (result) break;
        const uint8_t below = drawable_[scene_.instances.at(child).object];
        if (below == yes)
          result = true;
        else if (below == unknown && state != open) {
          todo.push_back(scene_.instances.at(child).object);
          wait = true;
        }
      }
      if (wait && !result) {
        drawable_[id] = open; // visited again once its children are known
        continue;
      }
      drawable_[id] = result ? yes : no;
      todo.pop_back();
    }
    return drawable_[root] == yes;
  }

  uint32_t partOf(uint32_t object) {
    const auto [found, fresh] = partOf_.try_emplace(object, uint32_t(result_.parts.size()));
    if (fresh) result_.parts.push_back({object, {}, {}, {}, {}});
    return found->second;
  }

  void walk(uint32_t part) {
    part_ = part;
    push({result_.parts[part].object, {}, {}, 0, 0});
    while (!stack_.empty() && !result_.truncated) step();
  }

  void push(const Frame& frame) {
    const auto found = scene_.objects.find(frame.object);
    if (found != scene_.objects.end() && !found->second.geometries.empty()) {
      if (!frame.matrix.usable()) {
        result_.rejected++;
      } else if (items_ >= maxPlacements) {
        result_.truncated = true;
        return;
      } else {
        items_++;
        result_.parts[part_].items.push_back({frame.object, frame.path, frame.matrix});
        if (paths_) result_.parts[part_].itemPaths.push_back(frame.step);
      }
    }
    if (!scene_.childrenOf(frame.object).empty()) stack_.push_back(frame);
  }

  void step() {
    Frame& top = stack_.back();
    const auto& children = scene_.childrenOf(top.object);
    if (top.next == children.size()) {
      stack_.pop_back();
      return;
    }
    const uint32_t id = children[top.next++];
    const Instance& instance = scene_.instances.at(id);
    if (!(instance.visible || instance.dynamic) || !drawable(instance.object)) return;
    const Inherited path =
        result_.inherit(top.path, {id, instance.shader, lightSetOf(id), instance.fog, instance.name,
                                   instance.userData});
    const auto object = scene_.objects.find(instance.object);
    if (instance.dynamic || (object != scene_.objects.end() && object->second.dynamic)) {
      const uint32_t part = partOf(instance.object);
      result_.parts[part_].sockets.push_back({id, part, path, top.matrix});
      if (paths_) result_.parts[part_].socketPaths.push_back(top.step);
      return;
    }
    const Frame below{instance.object, path, top.matrix * instance.matrix, stepBelow(top.step, id),
                      0};
    if (below.matrix.finite())
      push(below);
    else
      result_.rejected++;
  }

  uint32_t stepBelow(uint32_t above, uint32_t instance) {
    if (!paths_) return 0;
    result_.paths.push_back({instance, above});
    return uint32_t(result_.paths.size() - 1);
  }

  uint32_t lightSetOf(uint32_t instance) {
    const auto found = scoped_.find(instance);
    if (found == scoped_.end()) return 0;
    std::vector<uint32_t> all = result_.lightSets[0];
    all.insert(all.end(), found->second.begin(), found->second.end());
    std::sort(all.begin(), all.end());
    return result_.lightSet(all);
  }

  // Places the clusters breadth first: the children of a cluster are contiguous and come after it.
  void placeAll() {
    result_.clusters.push_back({});
    size_t placed = result_.parts[0].items.size();
    for (uint32_t c = 0; c < result_.clusters.size(); c++) {
      const std::vector<Socket>& sockets = result_.parts[result_.clusters[c].part].sockets;
      result_.clusters[c].firstChild = uint32_t(result_.clusters.size());
      for (uint32_t s = 0; s < sockets.size(); s++) {
        placed += result_.parts[sockets[s].part].items.size();
        if (placed > maxPlacements || result_.clusters.size() >= maxClusters) {
          truncate(c);
          return;
        }
        const Inherited path = result_.inherit(result_.clusters[c].path, sockets[s].path);
        result_.clusters.push_back({sockets[s].part, c, s, 0, path, {}, true});
        place(scene_, result_, uint32_t(result_.clusters.size() - 1));
        result_.clustersOf.emplace_back(sockets[s].instance, uint32_t(result_.clusters.size() - 1));
      }
    }
    std::sort(result_.clustersOf.begin(), result_.clustersOf.end());
  }

  // Removes the clusters below cluster c and after it when there are too many, so that every
  // cluster has all of its children or none.
  void truncate(uint32_t c) {
    result_.truncated = true;
    const uint32_t kept = result_.clusters[c].firstChild;
    result_.clusters.resize(kept);
    for (uint32_t i = c; i < kept; i++) result_.clusters[i].firstChild = none;
    std::erase_if(result_.clustersOf, [kept](const auto& entry) { return entry.second >= kept; });
    std::sort(result_.clustersOf.begin(), result_.clustersOf.end());
  }

 public:
  // firstChild of a cluster that had too many children.
  static constexpr uint32_t none = ~0u;

  static void place(const Scene& scene, Flattened& flat, uint32_t c) {
    Cluster& cluster = flat.clusters[c];
    const Cluster& parent = flat.clusters[cluster.parent];
    const Socket& socket = flat.parts[parent.part].sockets[cluster.socket];
    const Instance& instance = scene.instances.at(socket.instance);
    cluster.world = parent.world * socket.above * instance.matrix;
    cluster.visible = parent.visible && instance.visible;
  }

 private:
  const Scene& scene_;
  const bool paths_;
  Flattened result_;
  uint32_t part_ = 0;
  size_t items_ = 0;
  std::vector<Frame> stack_;
  std::unordered_map<uint32_t, std::vector<uint32_t>> scoped_;
  std::unordered_map<uint32_t, uint32_t> partOf_; // part index by object
  std::unordered_map<uint32_t, uint8_t> drawable_;
};

} // namespace

uint32_t Flattened::uniteLightSets(uint32_t a, uint32_t b) {
  if (a == b || b == 0) return a;
  if (a == 0) return b;
  std::vector<uint32_t> all;
  std::set_union(lightSets[a].begin(), lightSets[a].end(), lightSets[b].begin(), lightSets[b].end(),
                 std::back_inserter(all));
  return lightSet(all);
}

uint32_t Flattened::lightSet(const std::vector<uint32_t>& ids) {
  const auto [found, fresh] = setNumbers.try_emplace(ids, uint32_t(lightSets.size()));
  if (fresh) lightSets.push_back(ids);
  return found->second;
}

Inherited Flattened::inherit(const Inherited& outer, const Inherited& inner) {
  return {outer.instance ? outer.instance : inner.instance,
          outer.shader ? outer.shader : inner.shader,
          uniteLightSets(outer.lightSet, inner.lightSet),
          inner.fog ? inner.fog : outer.fog,
          inner.name ? inner.name : outer.name,
          inner.userData ? inner.userData : outer.userData};
}

std::vector<uint32_t> unscopedLights(const Scene& scene) {
  std::vector<uint32_t> result;
  for (const auto& [id, light] : scene.lights)
    if (!light.scope) result.push_back(id);
  return result;
}

Flattened flatten(const Scene& scene, bool paths) { return Flattener(scene, paths).run(); }

void addPaths(const Scene& scene, Flattened& flat) {
  Flattened again = flatten(scene, true);
  flat.paths = std::move(again.paths);
  for (size_t part = 0; part < flat.parts.size(); part++) {
    flat.parts[part].itemPaths = std::move(again.parts[part].itemPaths);
    flat.parts[part].socketPaths = std::move(again.parts[part].socketPaths);
  }
}

void dropPaths(Flattened& flat) {
  if (flat.paths.empty()) return;
  std::vector<PathStep>().swap(flat.paths);
  for (ScenePart& part : flat.parts) {
    std::vector<uint32_t>().swap(part.itemPaths);
    std::vector<uint32_t>().swap(part.socketPaths);
  }
}

std::vector<uint32_t> updateClusters(const Scene& scene, Flattened& flat,
                                     const std::vector<uint32_t>& instances) {
  std::vector<uint32_t> found;
  for (uint32_t id : instances) {
    auto it =
        std::lower_bound(flat.clustersOf.begin(), flat.clustersOf.end(), std::make_pair(id, 0u));
    for (; it != flat.clustersOf.end() && it->first == id; ++it) found.push_back(it->second);
  }
  std::sort(found.begin(), found.end());
  std::vector<uint32_t> all, open;
  std::vector<bool> seen(flat.clusters.size());
  for (uint32_t first : found) {
    open.push_back(first);
    while (!open.empty()) {
      const uint32_t c = open.back();
      open.pop_back();
      if (seen[c]) continue;
      seen[c] = true;
      all.push_back(c);
      const Cluster& cluster = flat.clusters[c];
      if (cluster.firstChild == Flattener::none) continue;
      for (size_t s = 0; s < flat.parts[cluster.part].sockets.size(); s++)
        open.push_back(cluster.firstChild + uint32_t(s));
    }
  }
  std::sort(all.begin(), all.end());
  for (uint32_t c : all) Flattener::place(scene, flat, c);
  return all;
}

} // namespace openrt
