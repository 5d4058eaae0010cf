// history.h: what has changed in a scene since the frame before, for RT_MOTION. Scene::apply()
// keeps here how changed instances and objects were in the frame before. It costs what has changed,
// and nothing while the frame lacks the channel. The local backend owns one beside its scene. Like
// the scene it follows from the commits alone, so every backend that has applied the commit of a
// frame and that of the frame before it finds the same motion.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/scene.h"

namespace openrt {

class SceneHistory {
 public:
  // Scene::apply() calls these. Between begin() and finish(), if watches(), it tells what it is
  // about to change.
  void begin(const Commit& commit);
  bool watches() const { return watches_; }
  void changeInstance(uint32_t id, const Instance& before);
  void addInstance(uint32_t id);
  void changeObject(uint32_t id, Object& before); // takes its geometries
  void addObject(uint32_t id);
  void finish(const Scene& scene, const Commit& commit);

  // Returns the number of the current frame's history; a new one begins with each frame.
  uint64_t number() const { return number_; }
  // Returns true if there was no frame before, so that everything is new.
  bool beginning() const { return beginning_; }
  // Returns true if anything may have moved or is new.
  bool any() const {
    return watches_ &&
           (beginning_ || !instances_.empty() || !newInstances_.empty() || !objects_.empty());
  }
  // Returns whether the instance is new or has changed.
  bool changed(uint32_t instance) const {
    return instances_.contains(instance) || newInstances_.contains(instance);
  }
  // Returns how a changed instance was in the frame before; null if it was not there or invisible.
  const Instance* before(uint32_t instance) const;
  // Returns whether the object was defined again.
  bool redefined(uint32_t object) const { return objects_.contains(object); }
  bool redefinedAny() const { return !objects_.empty(); }
  // Returns what a geometry of an object that was defined again was in the frame before; null if
  // there was no such geometry, or one of another topology.
  const Geometry* before(uint32_t object, size_t geometry) const;

 private:
  struct Past { // an object that was defined again
    std::vector<Geometry> geometries;
    std::vector<const Geometry*> matches; // by geometry of the new definition
  };
  void forget();
  void matchInstances(const Scene& scene);
  static void matchGeometries(Past& past, const std::vector<Geometry>& now);

  bool watches_ = false, beginning_ = true;
  bool framed_ = false; // a frame followed the last commit
  uint64_t number_ = 0;
  std::unordered_map<uint32_t, Instance> instances_; // changed or deleted ones, as they were
  std::unordered_set<uint32_t> newInstances_, newObjects_;
  std::unordered_map<uint32_t, uint32_t> replaced_; // new instances: those whose place they take
  std::unordered_map<uint32_t, Past> objects_;
};

} // namespace openrt
