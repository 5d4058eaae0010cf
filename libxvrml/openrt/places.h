// places.h: the part of the render graph whose meaning depends on the place, expanded: every way that leads to a light, a
// bindable, a billboard or an LOD. Everything else hangs below it unexpanded. Built once; world matrices, billboards and
// levels follow the camera.
#pragma once

#include <vector>

#include "openrt/graph.h"
#include "openrt/openrt.h"
#include "xvrml/openrt.h"

namespace xvrml::mapping {

struct Place {
  ItemId item = 0;
  int32_t parent = none;
  uint32_t firstChild = 0; // in Places::children, one for each child of the item: a place or `none`
  int32_t level = none;    // child of an LOD: which
  uint32_t name = 0;       // of the nearest named group, the item included
  bool inlined = false;    // below an Inline
  bool split = false;      // has an object of its own: root, billboards, LODs, their levels, groups that scope a light
  bool active = true;      // not in an LOD's level that is not chosen
  bool defined = false;    // its object's content has been written
  int32_t chosen = none;   // LOD: level in use
  int32_t drawn = none;    // LOD: level its object now holds
  Matrix world;            // of the item's children
  Matrix base;             // split: what its instance stands under in the parent object, without the billboard's turn
  RTid object = 0, instance = 0, light = 0;
};

struct Places {
  explicit Places(const Graph& graph);
  // World matrices, billboards' turns, levels of detail for a camera.
  void follow(const Graph& graph, const CameraSettings& camera);
  // The nearest place above (or at) `place` that has an object of its own.
  size_t splitAbove(int32_t place) const;

  std::vector<Place> all; // parents before children, in the order of the file; all[0] is the root
  std::vector<int32_t> children;
  std::vector<Matrix> turns; // by place: a billboard's turn, identity elsewhere
};

// Clause 6.26: the level for a distance. count: levels there are (> 0).
size_t levelOfDetail(const MFFloat& range, double distance, size_t count);

} // namespace xvrml::mapping
