// meshes.h: Shapes as glTF meshes. The arrays of a geometry node are written once, and so is each
// geometry with each material. [one thread]
#pragma once

#include <array>
#include <map>
#include <optional>
#include <unordered_map>

#include "libpicture/export/gltf/materials.h"
#include "libpicture/export/vertices.h"

namespace picture::gltf {

// The least box around the vertices of a shape, in its coordinates.
struct Box {
  xvrml::Vec3f low, high;
};

struct MeshUse {
  size_t mesh = 0;
  Box box;
};

class Meshes {
 public:
  Meshes(Document& document, Materials& materials, Remarks& remarks)
      : document_(document), materials_(materials), remarks_(remarks) {}
  // Returns the mesh of a shape; none if there is nothing to draw.
  std::optional<MeshUse> use(const xvrml::DrawnShape& shape);

 private:
  // Accessors of a geometry node; -1: not written.
  struct Geometry {
    xvrml::GeometryArrays::Kind kind = xvrml::GeometryArrays::Kind::empty;
    bool solid = true;
    VertexColors colors = VertexColors::none;
    int64_t points = -1, normals = -1, indices = -1;
    Box box;
    std::optional<size_t> colorValues;
    std::map<std::array<float, 6>, size_t> texCoords; // by their transform
  };
  Geometry write(const xvrml::GeometryArrays& arrays);
  size_t colorsOf(const xvrml::DrawnShape& shape, Geometry& geometry);
  size_t texCoords(const xvrml::DrawnShape& shape, const std::array<float, 6>& transform,
                   Geometry& geometry);
  Json primitiveOf(const xvrml::DrawnShape& shape, Geometry& geometry, const MaterialUse& material);

  Document& document_;
  Materials& materials_;
  Remarks& remarks_;
  std::unordered_map<const xvrml::Node*, Geometry> geometries_;
  // by geometry node and material
  std::map<std::pair<const xvrml::Node*, size_t>, size_t> meshes_;
};

} // namespace picture::gltf
