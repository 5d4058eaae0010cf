// flatten.cpp: a depth-first walk of the instances with a stack of its own: depth costs no call stack. Subtrees without
// geometry are pruned, so that a doubling tower of empty objects costs nothing.
#include "scene/flatten.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace openrt {
namespace {

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene) {
    for (const auto& [id, light] : scene.lights)
      if (light.scope) scoped_[light.scope].push_back(id);
    result_.lightSets.push_back(unscopedLights(scene));
    setOf_[result_.lightSets[0]] = 0;
  }

  Flattened run() {
    push(0, Frame{});
    while (!stack_.empty() && !result_.truncated) step();
    return std::move(result_);
  }

 private:
  struct Frame { // an object being walked, with what its path inherits
    uint32_t object = 0, instance = 0, shader = 0, lightSet = 0, name = 0;
    uint64_t userData = 0;
    Matrix4d matrix;
    size_t next = 0; // child to visit
  };

  // Whether an object or anything below it has geometry; computed once an object, iteratively.
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
        drawable_[id] = open; // visited again when its children are known
        continue;
      }
      drawable_[id] = result ? yes : no;
      todo.pop_back();
    }
    return drawable_[root] == yes;
  }

  void push(uint32_t object, Frame frame) {
    frame.object = object;
    frame.next = 0;
    const auto found = scene_.objects.find(object);
    if (found != scene_.objects.end() && !found->second.geometries.empty()) {
      if (!frame.matrix.usable()) {
        result_.rejected++;
      } else if (result_.placements.size() >= maxPlacements) {
        result_.truncated = true;
        return;
      } else {
        result_.placements.push_back(
            {object, frame.instance, frame.shader, frame.lightSet, frame.name, frame.userData, frame.matrix});
      }
    }
    if (!scene_.childrenOf(object).empty()) stack_.push_back(frame);
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
    if (!instance.visible || !drawable(instance.object)) return;
    Frame below;
    below.matrix = top.matrix * instance.matrix;
    if (!below.matrix.finite()) {
      result_.rejected++;
      return;
    }
    below.instance = top.instance ? top.instance : id;
    below.shader = top.shader ? top.shader : instance.shader;
    below.userData = instance.userData ? instance.userData : top.userData;
    below.name = instance.name ? instance.name : top.name;
    below.lightSet = scoped_.count(id) ? widen(top.lightSet, scoped_[id]) : top.lightSet;
    push(instance.object, below);
  }

  uint32_t widen(uint32_t set, const std::vector<uint32_t>& lights) {
    std::vector<uint32_t> all = result_.lightSets[set];
    all.insert(all.end(), lights.begin(), lights.end());
    std::sort(all.begin(), all.end());
    const auto [found, fresh] = setOf_.try_emplace(all, uint32_t(result_.lightSets.size()));
    if (fresh) result_.lightSets.push_back(all);
    return found->second;
  }

  const Scene& scene_;
  Flattened result_;
  std::vector<Frame> stack_;
  std::unordered_map<uint32_t, std::vector<uint32_t>> scoped_;
  std::map<std::vector<uint32_t>, uint32_t> setOf_;
  std::unordered_map<uint32_t, uint8_t> drawable_;
};

} // namespace

std::vector<uint32_t> unscopedLights(const Scene& scene) {
  std::vector<uint32_t> result;
  for (const auto& [id, light] : scene.lights)
    if (!light.scope) result.push_back(id);
  return result;
}

Flattened flatten(const Scene& scene) { return Flattener(scene).run(); }

} // namespace openrt
