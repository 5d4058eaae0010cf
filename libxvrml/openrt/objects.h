// objects.h: shapes as OpenRT objects and instances. A part is one object: the world, each split place, each item with an object
// of its own, each geometry that several shapes instantiate. A part is written when it is first needed and again when what it
// holds is grouped or looks otherwise; moving what it instantiates writes nothing. On the mapper's thread.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "openrt/appearance.h"
#include "openrt/places.h"
#include "openrt/ration.h"

namespace xvrml::mapping {

struct Part {
  enum class Of : uint8_t { nothing, place, item, mesh } of = Of::nothing;
  ItemId item = 0; // place and item
  int32_t mesh = none;
  int32_t level = none; // place: of an LOD
  RTid object = 0;
  bool defined = false, dirty = true;
  bool dynamic = false;                                              // as RT_DYNAMIC says
  uint64_t instances = 0;                                            // of it, in the parts that are defined
  uint64_t shapes = 0, triangles = 0, primitives = 0, drawCalls = 0; // written into it
  uint64_t bytes = 0;                                                // taken from the world's budget for what it holds
  uint64_t flat = 0;          // instances that one of it comes to, once what it instantiates is flattened (decision 2)
  uint64_t records = 0;       // draw calls that these instances come to
  double reach = 0;           // largest coordinate of what it holds
  std::vector<int32_t> uses;  // parts it instantiates, once for each time
  std::vector<ItemId> moving; // items of which it holds instances that are kept (Objects::placed_)
};

class Objects {
 public:
  Objects(World& world, bool linearColor, Graph& graph, Places& places, Surfaces& surfaces);

  // Writes what is active and not yet there or not as it should be, moves what follows the camera. Places::follow must have
  // run.
  void follow();

  // After the world was grouped anew: parts that are not needed any more go, with what was in the places that are gone.
  void regrouped(const std::vector<Place>& gone);
  // What these items hold is another: the objects that it is written into are to be written again. placing: they are placed
  // otherwise; the same for the objects that they stand in.
  void contentChanged(const std::vector<ItemId>& items);
  void placingChanged(const std::vector<ItemId>& items);
  // The mesh of a geometry's own object. False if it has none.
  bool meshChanged(int32_t mesh);
  // The item's matrix: its instances are moved. False if it has none that could be.
  bool moved(ItemId item);
  // A shape's surface; as moved().
  bool recolored(ItemId shape);

  void clear(); // deletes everything
  const std::vector<Part>& parts() const { return parts_; }
  uint64_t objects() const { return objects_; }
  uint64_t instances() const { return instances_; }
  uint64_t definitions() const { return definitions_; }
  uint64_t moves() const { return moves_; }

 private:
  struct Step {
    ItemId item;
    int32_t place; // or `none`: an item whose meaning does not depend on the place
    Matrix matrix; // that its content stands under, in the object being written
  };
  struct Placed { // an instance that events move or colour
    RTid instance;
    int32_t part; // that holds it
    Matrix base;  // without the item's own matrix
  };

  // Parts: parts.cpp.
  int32_t newPart(Part::Of of);
  void removePart(int32_t& part);
  int32_t partOfItem(ItemId item);
  int32_t partOfPlace(size_t place);
  int32_t partOfMesh(int32_t mesh);
  bool instantiated(const Item& item) const;
  void touch(int32_t part);
  void forget(Part& part); // what it holds

  // Definitions, in their order: objects.cpp.
  void definePlace(size_t place);
  void chooseLevel(size_t place);
  void defineDirty();
  void defineBelow(ItemId item, int32_t place);
  void defineItem(ItemId item);
  void defineMesh(int32_t mesh);
  void open(int32_t part, bool dynamic);
  void close();

  // Writes what a step leads to into the open object; the stack holds what is still to come: shapes.cpp.
  void enter(ItemId item, int32_t place, const Matrix& matrix);
  void expand(const Step& step);
  void drain();
  void writeShape(ItemId item, const Matrix& matrix);
  bool draw(int32_t mesh, const Surface& surface, bool textured);
  void drawArrays(const Mesh& mesh, const Surface& surface, bool textured);
  bool tooFar(const Matrix& matrix, double reach, const SourcePosition& where, const std::string& what);
  // number: of the shape that the instance is; 0: shapes below have their own.
  RTid instantiate(int32_t part, const Matrix& matrix, uint32_t number, bool dynamic);
  void keep(ItemId item, RTid instance, const Matrix& base);

  World& world_;
  bool linear_;
  Graph& graph_;
  Places& places_;
  Surfaces& surfaces_;
  Ration ration_;
  std::vector<Part> parts_;
  std::vector<int32_t> freeParts_, meshParts_, dirty_;
  std::unordered_map<ItemId, std::vector<Placed>> placed_;
  std::vector<uint8_t> met_; // items below which everything has been defined
  std::vector<Step> stack_;
  std::vector<uint32_t> seen_; // by item: number of the last walk upwards that met it
  uint32_t walk_ = 0;
  int32_t writing_ = none;    // the open part
  bool live_ = false;         // the world runs: hints are given
  std::vector<float> colors_; // scratch
  uint64_t objects_ = 0, instances_ = 0, definitions_ = 0, moves_ = 0;
};

} // namespace xvrml::mapping
