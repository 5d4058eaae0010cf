// meshes.h: the meshes of a world, one per geometry node however many shapes use it, and which of
// them are equal. Built when first asked for, by the mapper.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "geometry/matrix.h"
#include "geometry/mesh.h"
#include "mapper/ration.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

class Meshes {
 public:
  explicit Meshes(World& world) : world_(world), ration_(world, "meshes") {}
  // The number of a geometry node's mesh, with one user more. textured: a shape that uses it has a
  // texture.
  int32_t add(Node& geometry, bool textured);
  void drop(int32_t mesh); // one user less
  // Numbers that have no user any more. They name nothing else until recycle().
  const std::vector<int32_t>& dropped() const { return dropped_; }
  void recycle();
  int32_t find(const Node* geometry) const;
  size_t size() const { return entries_.size(); }
  // Its shapes have a texture from now on. True if the mesh is another because of that.
  bool needTexture(int32_t mesh);
  // The node has other fields.
  void changed(int32_t mesh);
  // Events reach the geometry: it is never the same as another.
  void setDynamic(int32_t mesh, bool dynamic);
  bool dynamic(int32_t mesh) const { return entries_[size_t(mesh)].dynamic; }

  const Mesh& get(int32_t mesh);
  Node& geometry(int32_t mesh) const { return *entries_[size_t(mesh)].geometry; }
  // What get(mesh) draws; known without keeping the mesh.
  struct Extent {
    Mesh::Kind kind = Mesh::Kind::empty;
    uint64_t primitives = 0;
    double reach = 0; // largest coordinate
  };
  Extent extent(int32_t mesh);
  // The mesh whose object draws this one too: one with equal content, perhaps itself.
  int32_t equal(int32_t mesh) const;
  // Shapes that use this mesh or one of equal content.
  uint32_t users(int32_t mesh) const;
  // Grows bounds by the mesh under a matrix.
  void grow(Bounds& bounds, int32_t mesh, const Matrix& matrix);
  // Returns how far from a point the mesh under a matrix reaches; of a sphere that is not round at
  // least so far.
  double reach(int32_t mesh, const Matrix& matrix, const Vector& from);
  // Forgets the arrays; get() would build them again.
  void release();

 private:
  static constexpr int32_t none_ = -1;
  struct Entry {
    NodeRef geometry;
    std::unique_ptr<Mesh> mesh; // null: not built, or released
    Extent extent;
    uint64_t triangles = 0; // at most: as the budget was when it was built first
    uint32_t users = 0;
    int32_t group = none_, next = none_, previous = none_; // those of equal content
    bool textured = false, known = false, dynamic = false, said = false;
  };
  struct Group { // of meshes with equal content
    uint64_t hash = 0;
    uint32_t users = 0;
    int32_t first = none_; // member that stands for all
    int32_t next = none_;  // group of the same hash, or free
  };
  bool sameContent(int32_t a, int32_t b);
  void join(int32_t mesh); // those of equal content
  void leave(int32_t mesh);
  int32_t newGroup(uint64_t hash);
  void count(int32_t mesh, int32_t users);

  World& world_;
  Ration ration_; // of the meshes that are built now
  std::vector<Entry> entries_;
  std::vector<int32_t> free_, dropped_, built_;
  std::unordered_map<const Node*, int32_t> index_;
  std::vector<Group> groups_;
  int32_t freeGroup_ = none_;
  std::unordered_map<uint64_t, int32_t> byContent_; // first group of each hash
};

// The mesh with only the vertices that its indices use, in their order.
void compact(const Mesh& mesh, Mesh& out);

void growByPoint(Bounds& bounds, const Vector& point);
void growByBox(Bounds& bounds, const Bounds& box, const Matrix& matrix);

} // namespace xvrml::mapper
