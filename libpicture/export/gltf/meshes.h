// meshes.h: Shapes as glTF meshes. The arrays of a geometry node are written once, and so is each
// geometry with each material. [one thread]
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "libpicture/export/gltf/materials.h"
#include "libpicture/export/gltf/variants.h"
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
  // Returns the mesh of a shape; none if there is nothing to draw. chooser: a Switch that chooses
  // between the looks of the shape, or null.
  std::optional<MeshUse> use(const xvrml::DrawnShape& shape,
                             const xvrml::nodes::Switch* chooser = nullptr);
  // Writes what all meshes have together. Call it after the walk.
  void finish() { variants_.write(document_); }

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
  Geometry describe(const xvrml::GeometryArrays& arrays);
  void write(const xvrml::GeometryArrays& arrays, Geometry& geometry);
  size_t colorsOf(const xvrml::DrawnShape& shape, Geometry& geometry);
  size_t texCoords(const xvrml::DrawnShape& shape, const std::array<float, 6>& transform,
                   Geometry& geometry);
  using MaterialOf = std::function<MaterialUse(const xvrml::AppearanceParts&)>;
  Json mappingsOf(const xvrml::nodes::Switch& chooser, const MaterialOf& materialOf,
                  MaterialUse& attributes);
  Json primitiveOf(const xvrml::DrawnShape& shape, Geometry& geometry, const MaterialUse& material);

  Document& document_;
  Materials& materials_;
  Remarks& remarks_;
  std::unordered_map<const xvrml::Node*, Geometry> geometries_;
  // by geometry node, material and the Switch that chooses between others
  std::map<std::tuple<const xvrml::Node*, size_t, const xvrml::Node*>, size_t> meshes_;
  Variants variants_;
};

} // namespace picture::gltf
