// objects.h: shapes as OpenRT objects and instances: one object for the world and one for each split place, one for each shared
// item and shared geometry. Written once; later cameras only turn billboards and choose levels. On the mapper's thread.
#pragma once

#include <vector>

#include "openrt/appearance.h"
#include "openrt/places.h"

namespace xvrml::mapping {

class Objects {
 public:
  Objects(World& world, bool linearColor, Graph& graph, Places& places, Surfaces& surfaces);

  // Writes what is active and not yet there, moves what follows the camera. Places::follow must have run.
  void follow();
  void remove(); // everything
  uint64_t objects() const { return objects_; }
  uint64_t instances() const { return instances_; }

 private:
  struct Step {
    ItemId item;
    int32_t place; // or `none`: an item whose meaning does not depend on the place
    Matrix matrix; // it stands under, in the object being written
    uint32_t name;
  };

  void definePlace(size_t place);
  void chooseLevel(size_t place);
  void defineSharedBelow(ItemId item, int32_t place);
  void defineItem(ItemId item);
  void defineMesh(int32_t mesh);
  // Writes what a step leads to into the open object; the stack holds what is still to come.
  void enter(ItemId item, int32_t place, const Matrix& matrix, uint32_t name);
  void expand(const Step& step);
  void drain();
  void writeShape(const Item& item, const Matrix& matrix, uint32_t name);
  void draw(int32_t mesh, const Surface& surface, bool textured);
  void drawArrays(const Mesh& mesh, const Surface& surface, bool textured);
  RTid begin();
  std::vector<RTid> made_;
  RTid instantiate(RTid object, const Matrix& matrix, uint32_t name);
  bool sharesGeometry(int32_t mesh);
  // The name to give: that of the nearest group, else the type's; none in a shared object, where each instance brings it.
  uint32_t givenName(const Item& item, uint32_t name);

  World& world_;
  bool linear_;
  Graph& graph_;
  Places& places_;
  Surfaces& surfaces_;
  std::vector<RTid> itemObjects_, meshObjects_;
  std::vector<uint8_t> met_; // items below which all that is shared has been defined
  std::vector<Step> stack_;
  bool inShared_ = false;     // the open object is a shared one
  std::vector<float> colors_; // scratch
  uint64_t objects_ = 0, instances_ = 0;
};

} // namespace xvrml::mapping
