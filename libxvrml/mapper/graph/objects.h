// objects.h: writes shapes as OpenRT objects and instances. A part is one object. It belongs to the
// world, a split place, an item with an object of its own, or a geometry that several shapes
// instantiate. A part is written when it is first needed, and again when its content is regrouped
// or looks different. Moving the parts it instantiates does not rewrite it. [the mapper's thread]
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "mapper/graph/places.h"
#include "mapper/ration.h"
#include "mapper/shading/appearance.h"

namespace xvrml::mapper {

// Returns the matrix of an instance, which must be finite. Another one makes it nothing of size 0,
// so that it does not stay where it was before.
inline Matrix placing(const Matrix& matrix) { return finite(matrix) ? matrix : scaling(Vector(0)); }

struct Part {
  enum class Kind : uint8_t { nothing, place, item, mesh } kind = Kind::nothing;
  ItemId item = 0; // set for place and item
  int32_t mesh = none;
  int32_t level = none; // for a place: level of the LOD above it
  RTid object = 0;
  bool defined = false, dirty = true;
  bool dynamic = false;   // hinted as RT_DYNAMIC
  uint64_t instances = 0; // instances of this part in the defined parts
  // Content written into the part.
  uint64_t shapes = 0, triangles = 0, primitives = 0, drawCalls = 0;
  uint64_t bytes = 0; // bytes taken from the world's budget for the part's content
  // Instances that one instance of this part becomes when everything below is flattened (decision
  // 2).
  uint64_t flattenedInstances = 0;
  uint64_t records = 0;      // draw calls of these instances
  double reach = 0;          // largest coordinate of its content
  std::vector<int32_t> uses; // parts that it instantiates, one entry per instance
  // Items with tracked instances in this part (Objects::trackedInstances_).
  std::vector<ItemId> moving;
};

class Objects {
 public:
  Objects(World& world, bool linearColor, Graph& graph, Places& places, Surfaces& surfaces);

  // Writes the active parts that are missing or out of date and moves what depends on the camera.
  // Places::updateForFrame must have run before.
  void updateForFrame();

  // Removes parts that are no longer needed after the world was regrouped, including those of the
  // places in `gone`.
  void regrouped(const std::vector<Place>& gone);
  // Marks objects as dirty. contentChanged: those that contain these items, whose content has
  // changed. placingChanged: those that contain their parents, because the items are placed
  // differently.
  void contentChanged(const std::vector<ItemId>& items);
  void placingChanged(const std::vector<ItemId>& items);
  // Marks the object of a geometry as dirty. Returns false if the geometry has none.
  bool meshChanged(int32_t mesh);
  // Applies a new matrix of the item to its instances. Returns false if it has no movable instance.
  bool moved(ItemId item);
  // Applies a new surface to the instances of a shape. Returns false as moved() does.
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
    int32_t place; // index into Places::all; `none` if the item does not depend on its place
    Matrix matrix; // matrix from the item's content to the object being written
  };
  struct TrackedInstance { // an instance that events move or colour
    RTid instance;
    int32_t part; // the part that holds the instance
    Matrix base;  // matrix without the item's own matrix
  };

  // parts.cpp: the list of parts.
  int32_t newPart(Part::Kind kind);
  void removePart(int32_t& part);
  int32_t partOfItem(ItemId item);
  int32_t partOfPlace(size_t place);
  int32_t partOfMesh(int32_t mesh);
  bool instantiated(const Item& item) const;
  void touch(int32_t part);
  void clearContent(Part& part); // drops the record of its content

  // objects.cpp: definitions, in the order in which they are written.
  void definePlace(size_t place);
  void chooseLevel(size_t place);
  void defineDirty();
  void defineBelow(ItemId item, int32_t place);
  void defineItem(ItemId item);
  void defineMesh(int32_t mesh);
  void open(int32_t part, bool dynamic);
  void close();

  // shapes.cpp: writes the content of a step into the open object. The stack holds the remaining
  // steps.
  void enter(ItemId item, int32_t place, const Matrix& matrix);
  void expand(const Step& step);
  void drain();
  SurfaceUse useOf(const Item& shape) const;
  void writeShape(ItemId item, const Matrix& matrix);
  // kept: what ClipPlanes leave of the mesh, in its coordinates.
  bool draw(int32_t mesh, const Surface& surface, bool textured, const HalfSpaces& kept = {});
  // linear: colours of the mesh are still to be decoded to linear light.
  void drawArrays(const Mesh& mesh, const Surface& surface, bool textured, bool linear);
  void measure(const Matrix& matrix, double reach, const Node* node, bool isShape);
  // number: the number of the shape that the instance draws; 0 if the shapes below have their own.
  RTid instantiate(int32_t part, const Matrix& matrix, uint32_t number, bool dynamic);
  void keep(ItemId item, RTid instance, const Matrix& base);

  World& world_;
  bool linear_;
  Graph& graph_;
  Places& places_;
  Surfaces& surfaces_;
  Quota quota_;
  std::vector<Part> parts_;
  std::vector<int32_t> freeParts_, meshParts_, dirty_;
  std::unordered_map<ItemId, std::vector<TrackedInstance>> trackedInstances_;
  std::vector<uint8_t> definedBelow_; // by item: 1 if everything below it has been defined
  std::vector<Step> stack_;
  std::vector<uint32_t> seen_; // by item: number of the last upward walk that visited it
  uint32_t walk_ = 0;
  int32_t writing_ = none;                  // the open part
  HalfSpaces kept_;                         // what ClipPlanes leave of it, in its coordinates
  bool live_ = false;                       // the world is running, so dynamic hints are given
  std::unordered_set<const Node*> toldFar_; // nodes that were warned of
  std::vector<float> colors_;               // scratch storage for colours
  uint64_t objects_ = 0, instances_ = 0, definitions_ = 0, moves_ = 0;
};

} // namespace xvrml::mapper
