// light_tree.h: chooses one of many lights, with a probability near its share of the light that arrives: a binary tree of boxes,
// cones and strengths. A. Conty Estevez, C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018;
// the measure of nodes follows M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., 12.6.3, up to the law of
// distance, which is in units of the scene's own. Built between frames, always the same for the same lights; read by all render
// threads. A choice costs one walk from the root, its probability another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace openrt {

// Where a light, or several, are and what they send out. Bounds must hold: a light chosen never is light lost.
struct LightBounds {
  float low[3], high[3];
  float axis[3] = {0, 0, 1};     // unit; of the cone of normals, or of what a spot light lights
  float cosineNormals = -1;      // of that cone's half angle; -1: any direction
  float cosineBeyond = 0;        // of the angle up to which light leaves a normal: 0: a surface, 1: the cone's directions alone
  bool bothSides = false;        // the opposite cone as well
  float intensity = 0;           // largest radiant intensity, falling with the square of the distance
  float irradiance = 0;          // part that does not fall
  float reach = 3.402823466e38f; // nothing is lit beyond
};

class LightTree {
 public:
  struct Choice {
    uint32_t light = 0;
    float probability = 0; // 0: no light reaches the place
  };

  // What a normal says: light counts from its side only, or it mostly does.
  enum class Side : uint8_t { only, likely };

  void build(std::span<const LightBounds> lights);
  bool empty() const { return nodes_.empty(); }
  size_t bytes() const { return nodes_.size() * sizeof(Node) + trails_.size() * sizeof(Trail); }
  // One of the lights for a place; normal: null: light counts from everywhere. pick: of [0, 1).
  Choice choose(const float place[3], const float* normal, double pick, Side side = Side::only) const;
  float probability(const float place[3], const float* normal, uint32_t light) const;
  uint32_t depth() const { return depth_; }

 private:
  struct Node {
    LightBounds bounds;
    uint32_t next; // the second child (the first one follows the node), or the light
    bool leaf;
  };
  struct Trail { // of a light: at each step down, 1: the second child; the first step in the lowest bit
    uint64_t bits = 0;
    uint32_t steps = 0;
  };
  static float measure(const LightBounds& bounds, const float place[3], const float* normal, Side side = Side::only);
  std::vector<Node> nodes_;
  std::vector<Trail> trails_; // by light; steps ~0: it sends out nothing
  uint32_t depth_ = 0;
};

} // namespace openrt
