// light_tree.h: chooses one of many lights, with a probability near its share of the light that
// arrives: a tree of boxes, cones and strengths, eight children side by side. A. Conty Estevez, C.
// Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018; the measure
// of nodes follows M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., 12.6.3,
// up to the law of distance, which is in units of the scene's own. Built between frames, always the
// same for the same lights; read by all render threads. A choice costs one walk from the root, its
// probability another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace openrt {

// Where a light, or several, are and what they send out. Bounds must hold: a light chosen never is
// light lost.
struct LightBounds {
  float low[3], high[3];
  float axis[3] = {0, 0, 1}; // unit; of the cone of normals, or of what a spot light lights
  float cosineNormals = -1;  // of that cone's half angle; -1: any direction
  float cosineBeyond = 0;    // of the angle up to which light leaves a normal: 0: a surface, 1: the
                             // cone's directions alone
  bool bothSides = false;    // the opposite cone as well
  float intensity = 0;       // largest radiant intensity, falling with the square of the distance
  float irradiance = 0;      // part that does not fall
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
  size_t bytes() const { return nodes_.size() * sizeof(Node) + places_.size() * sizeof(Place); }
  // One of the lights for a place; normal: null: light counts from everywhere. pick: of [0, 1).
  Choice choose(const float place[3], const float* normal, double pick,
                Side side = Side::only) const;
  float probability(const float place[3], const float* normal, uint32_t light) const;
  uint32_t depth() const { return depth_; }

 private:
  static constexpr uint32_t width = 8;
  // Up to eight children side by side, for vector lanes. What does not depend on the place is
  // worked out.
  struct Node {
    float centre[3][width], radius2[width],
        reach2[width]; // of the box's sphere; squared, from the centre
    float axis[3][width], cosine[width], sine[width], beyond[width], both[width];
    float intensity[width], irradiance[width], used[width];
    uint32_t child[width]; // a node, or a light
    bool leaf[width];
    uint32_t parent, slot; // none: the root
  };
  struct Place { // of a light
    uint32_t node, slot;
  };
  struct Query;
  static void measure(const Node& node, const Query& query, float* __restrict out);
  void fill(uint32_t node, uint32_t slot, const LightBounds& bounds);
  std::vector<Node> nodes_;
  std::vector<Place> places_; // by light; node ~0: it sends out nothing
  uint32_t depth_ = 0;
};

} // namespace openrt
