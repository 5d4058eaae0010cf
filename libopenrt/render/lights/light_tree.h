// light_tree.h: light BVH: samples one of many lights with a probability close to its share of the
// light that arrives. It is a tree of boxes, cones and intensities with eight children per node. A.
// Conty Estevez, C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG
// 2018. The importance of nodes follows M. Pharr, W. Jakob, G. Humphreys, "Physically Based
// Rendering", 4th ed., 12.6.3, except for the distance falloff, which is in units of the scene.
// Built between frames, deterministic for the same lights; read by all render threads. Sampling a
// light costs one walk from the root, its probability another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/lights/light_node.h"
#include "scene/vec3.h"

namespace openrt {

// Bounds of one light or a group of lights. They must be conservative: a light with selection
// probability 0 is lost light.
struct LightBounds {
  Vec3f low, high;
  Vec3f axis{0, 0, 1};      // unit axis of the cone of normals, or of a spot light's cone
  float cosineNormals = -1; // cosine of that cone's half angle; -1: any direction
  // Cosine of the angle up to which light is emitted about a normal. 0: a surface; 1: only the
  // cone's directions.
  float cosineEmission = 0;
  bool bothSides = false;        // the opposite cone emits as well
  float intensity = 0;           // largest radiant intensity; falls with the squared distance
  float irradiance = 0;          // irradiance that does not fall with distance
  float reach = 3.402823466e38f; // radius of influence
};

class LightTree {
 public:
  struct Choice {
    uint32_t light = 0;
    float probability = 0; // 0: no light reaches the point
  };

  using Side = ReceiverSide;

  void build(std::span<const LightBounds> lights);
  bool empty() const { return nodes_.empty(); }
  size_t bytes() const { return nodes_.size() * sizeof(Node) + places_.size() * sizeof(Place); }
  // Samples a light for a point. normal: 0 0 0 if light counts from everywhere. pick in [0, 1).
  Choice choose(const Vec3f& place, const Vec3f& normal, double pick, Side side = Side::only) const;
  float probability(const Vec3f& place, const Vec3f& normal, uint32_t light) const;
  uint32_t depth() const { return depth_; }
  // Returns the root, which must exist.
  const LightNode& root() const { return nodes_.front(); }
  // Returns whether the root is the only node: the tree has at most eight lights.
  bool hasOneNode() const { return nodes_.size() == 1; }

 private:
  using Node = LightNode;
  static constexpr uint32_t width = LightNode::width;
  struct Place { // node and child slot of a light
    uint32_t node, slot;
  };
  void fill(uint32_t node, uint32_t slot, const LightBounds& bounds);
  std::vector<Node> nodes_;
  std::vector<Place> places_; // by light; node ~0: the light emits nothing
  uint32_t depth_ = 0;
};

} // namespace openrt
