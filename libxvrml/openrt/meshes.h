// meshes.h: the meshes of a world, one per geometry node however many shapes use it. Built when first asked for, by the mapper.
#pragma once

#include <unordered_map>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/matrix.h"
#include "xvrml/openrt.h"

namespace xvrml::mapping {

class Meshes {
 public:
  explicit Meshes(World& world) : world_(world) {}
  // The number of a geometry node's mesh. textured: a shape that uses it has a texture.
  int32_t add(Node& geometry, bool textured);
  size_t size() const { return entries_.size(); }

  const Mesh& get(int32_t mesh);
  Node& geometry(int32_t mesh) const { return *entries_[size_t(mesh)].geometry; }
  uint32_t users(int32_t mesh) const { return entries_[size_t(mesh)].users; }
  // What get(mesh) draws; known without keeping the mesh.
  struct Extent {
    Mesh::Kind kind = Mesh::Kind::empty;
    uint64_t primitives = 0;
  };
  Extent extent(int32_t mesh);
  // Grows bounds by the mesh under a matrix.
  void grow(Bounds& bounds, int32_t mesh, const Matrix& matrix);
  // Forgets the arrays; get() would build them again.
  void release();

 private:
  struct Entry {
    Node* geometry = nullptr;
    bool textured = false, built = false, known = false;
    uint32_t users = 0; // shapes
    Extent extent;
    Mesh mesh;
  };
  World& world_;
  std::vector<Entry> entries_;
  std::unordered_map<const Node*, int32_t> index_;
};

// The mesh with only the vertices that its indices use, in their order.
void compact(const Mesh& mesh, Mesh& out);

void growByPoint(Bounds& bounds, const Vector& point);
void growByBox(Bounds& bounds, const Bounds& box, const Matrix& matrix);

} // namespace xvrml::mapping
