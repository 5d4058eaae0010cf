// view_history.h: what has changed in a scene since the last frame of one view (RT_VIEW), for
// RT_MOTION: how changed instances and objects were in that frame. A SceneHistory (history.h) owns
// one for each view and fills it while commits are applied; the backend reads it.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/scene.h"

namespace openrt {

class ViewHistory {
 public:
  // The view has had a frame: changes are those since then.
  void beginAnew();
  // Drops what has been noted.
  void forget();
  void changeInstance(uint32_t id, const Instance& before);
  void addInstance(uint32_t id);
  void changeObject(uint32_t id, const FormerGeometries& before);
  void addObject(uint32_t id);
  // Finds the new instances and geometries that take the places of earlier ones. All changes of the
  // view's next frame have been noted.
  void match(const Scene& scene);

  // Returns true if the view has had no frame, so that everything is new.
  bool beginning() const { return beginning_; }
  // Returns true if anything may have moved or is new.
  bool any() const {
    return beginning_ || !instances_.empty() || !newInstances_.empty() || !objects_.empty();
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
    FormerGeometries geometries;
    std::vector<const Geometry*> matches; // by geometry of the new definition
  };
  void matchInstances(const Scene& scene);
  static void matchGeometries(Past& past, const std::vector<Geometry>& now);

  bool beginning_ = true;
  std::unordered_map<uint32_t, Instance> instances_; // changed or deleted ones, as they were
  std::unordered_set<uint32_t> newInstances_, newObjects_;
  std::unordered_map<uint32_t, uint32_t> replaced_; // new instances: those whose place they take
  std::unordered_map<uint32_t, Past> objects_;
};

} // namespace openrt
