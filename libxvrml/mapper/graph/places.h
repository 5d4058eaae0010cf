// places.h: the place-dependent part of the render graph, expanded: one Place for every path to a
// light, a LocalFog, a bindable node, a ClipPlane, a Billboard, an LOD or a group that events
// change. Everything else hangs below it unexpanded. It is rebuilt when a place-dependent item is
// regrouped; places that still exist keep their objects and lights. World matrices, billboards and
// levels are updated for the camera.
#pragma once

#include <vector>

#include "geometry/half_space.h"
#include "mapper/graph/graph.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

struct Place {
  ItemId item = 0;
  int32_t parent = none;
  // Index into Places::children: one entry per child of the item, a place or `none`.
  uint32_t firstChild = 0;
  uint32_t childCount = 0;
  int32_t level = none; // for a child of an LOD: its level
  bool inlined = false; // below an Inline
  // The place at or above this one that limits lights (Item::limitsLights).
  int32_t limit = none;
  // Has an object of its own: the root, billboards, LODs, LOD levels, groups that events reach,
  // groups that scope a light or a LocalFog, groups with ClipPlanes.
  bool split = false;
  bool active = true;    // not in an unselected level of an LOD
  int32_t chosen = none; // for an LOD: the level in use
  Matrix world;          // world matrix of the item's children
  // For a split place: the matrix of the item in the parent object, without the item's own matrix.
  Matrix base;
  // For a split place below ClipPlanes, or with some: what they leave, in coordinates of its
  // object.
  HalfSpaces kept;
  bool recut = false; // `kept` has changed since the object was written

  // Objects, lights and fogs created for the place. A rebuild keeps them.
  int32_t drawn = none; // for an LOD: the level that its object now holds
  int32_t part = none;  // index into the parts of Objects
  RTid instance = 0;
  RTid light = 0, lightScope = 0;
  Matrix lightMatrix;
  RTid fog = 0, fogScope = 0; // the shader of a LocalFog, and the instance that has it
  Matrix fogMatrix;
};

class Places {
 public:
  explicit Places(World& world) : quota_(world, "lights, views, billboards and levels of detail") {}
  // Builds the places, keeping what exists of the previous ones. gone: previous places that no
  // longer exist, with what was created for them.
  void build(const Graph& graph, std::vector<Place>& gone);
  // Updates world matrices, billboard rotations, LOD levels and what ClipPlanes leave for a camera.
  void updateForFrame(const Graph& graph, const CameraSettings& camera);
  // Returns the nearest place at or above `place` that has an object of its own.
  size_t splitAbove(int32_t place) const;
  // Visits the places of an item in file order.
  template <class Visit> void each(ItemId item, const Visit& visit) const {
    if (item >= firstOf_.size()) return;
    for (int32_t place = firstOf_[item]; place != none; place = nextOf_[size_t(place)])
      visit(place);
  }

  std::vector<Place> all; // parents before children, in file order; all[0] is the root
  std::vector<int32_t> children;
  std::vector<Matrix> billboardRotations; // by place: a billboard's rotation, identity elsewhere

 private:
  Quota quota_;
  uint64_t taken_ = 0; // bytes taken from quota_
  void expand(const Graph& graph);
  void inherit(std::vector<Place>& before, const std::vector<int32_t>& childrenBefore,
               std::vector<Place>& gone);
  void index(size_t items);
  void updateHalfSpaces(const Graph& graph);

  bool clips_ = false;                    // some item clips, or did before the last update
  std::vector<int32_t> firstOf_, nextOf_; // linked lists: the places of each item
};

// Returns the LOD level for a distance (clause 6.26). count: number of levels, > 0.
size_t levelOfDetail(const MFFloat& range, double distance, size_t count);

} // namespace xvrml::mapper
