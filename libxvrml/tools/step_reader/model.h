// model.h: a model as Open CASCADE has read it, in the terms of glTF: a tree of nodes that place
// meshes. Lengths are metres. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace xvrml::decoding {

// Faces of one colour.
struct Primitive {
  size_t material = 0;
  std::vector<float> points{}, normals{}; // three for each vertex
  std::vector<uint32_t> corners{};        // three vertices for each triangle, counter-clockwise
};

struct Mesh {
  std::string name;
  std::array<double, 3> origin{}; // points of the part are these and those of the primitives
  std::vector<Primitive> primitives{};
};

struct ModelNode {
  std::string name;
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{0, 0, 0, 1}; // a quaternion, the real part last
  double scale = 1;
  std::optional<size_t> mesh;
  std::vector<size_t> children;
};

struct Model {
  using Material = std::array<float, 4>; // linear red, green, blue; opacity
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<ModelNode> nodes;
  std::vector<size_t> roots;
  uint64_t leftOut = 0; // faces that could not be divided into triangles
};

// Returns a model as the two parts of a binary glTF file (Khronos, glTF 2.0, 4.4): everything
// before the numbers, and the numbers.
struct GlbParts {
  std::string head, numbers;
};
GlbParts writeGlb(Model&& model, const std::string& generator);

} // namespace xvrml::decoding
