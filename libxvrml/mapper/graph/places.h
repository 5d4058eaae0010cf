// places.h: the part of the render graph whose meaning depends on the place, expanded: every way
// that leads to a light, a bindable, a billboard, an LOD or a group that events change. Everything
// else hangs below it unexpanded. Built anew when something placed is grouped anew, with what the
// places were before; world matrices, billboards and levels follow the camera.
#pragma once

#include <vector>

#include "mapper/graph/graph.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

struct Place {
  ItemId item = 0;
  int32_t parent = none;
  uint32_t firstChild = 0; // in Places::children, one for each child of the item: a place or `none`
  uint32_t childCount = 0;
  int32_t level = none; // child of an LOD: which
  bool inlined = false; // below an Inline
  bool split = false; // has an object of its own: root, billboards, LODs, their levels, what events
                      // reach or scopes a light
  bool active = true; // not in an LOD's level that is not chosen
  int32_t chosen = none; // LOD: level in use
  Matrix world;          // of the item's children
  Matrix base; // split: what the item stands under in the parent object, without its own matrix

  // What has been made of it; goes on when places are built anew.
  int32_t drawn = none; // LOD: level its object now holds
  int32_t part = none;  // of Objects
  RTid instance = 0;
  RTid light = 0, lightScope = 0;
  Matrix lightMatrix;
};

class Places {
 public:
  explicit Places(World& world)
      : ration_(world, "lights, views, billboards and levels of detail") {}
  // From nothing, or with what is left of the places before. gone: those of them that are no more,
  // with what was made of them.
  void build(const Graph& graph, std::vector<Place>& gone);
  // World matrices, billboards' turns, levels of detail for a camera.
  void follow(const Graph& graph, const CameraSettings& camera);
  // The nearest place above (or at) `place` that has an object of its own.
  size_t splitAbove(int32_t place) const;
  // Of an item, in the order of the file.
  template <class Visit> void each(ItemId item, const Visit& visit) const {
    if (item >= firstOf_.size()) return;
    for (int32_t place = firstOf_[item]; place != none; place = nextOf_[size_t(place)])
      visit(place);
  }

  std::vector<Place> all; // parents before children, in the order of the file; all[0] is the root
  std::vector<int32_t> children;
  std::vector<Matrix> turns; // by place: a billboard's turn, identity elsewhere

 private:
  Ration ration_;
  uint64_t taken_ = 0; // of it
  void expand(const Graph& graph);
  void inherit(std::vector<Place>& before, const std::vector<int32_t>& childrenBefore,
               std::vector<Place>& gone);
  void index(size_t items);

  std::vector<int32_t> firstOf_, nextOf_; // places of each item, as lists
};

// Clause 6.26: the level for a distance. count: levels there are (> 0).
size_t levelOfDetail(const MFFloat& range, double distance, size_t count);

} // namespace xvrml::mapper
