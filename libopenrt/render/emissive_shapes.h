// emissive_shapes.h: triangles and spheres whose surface emits, with a light tree over them. Made between frames when places,
// shaders or textures have changed, read by all render threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/light_tree.h"

namespace openrt {

struct RenderScene;
class Arena;

class EmissiveShapes {
 public:
  struct Shape {
    uint32_t record, primitive;
    uint8_t sides; // 1: the side that the corners turn to (of a sphere: outside) emits, 2: the other
    bool sphere;
    float corner[3][3]; // triangle: render space, turning as the kernel's normal tells
    bool swapped;       // corner 1 and 2 are the record's 2 and 1
    float power;        // about proportional to the flux
  };

  explicit EmissiveShapes(const RenderScene& scene);
  bool empty() const { return tree_.empty(); }
  size_t size() const { return shapes_.size(); }
  double brightest() const { return brightest_; } // largest mean radiance of a shape's side, colours summed
  const Shape& operator[](uint32_t number) const { return shapes_[number]; }
  const LightTree& tree() const { return tree_; }
  // A place on a shape. u, v: even numbers of the unit square; area: of the whole shape, or what makes up for uneven places.
  struct Place {
    float position[3], normal[3], u, v;
    double area;
  };
  Place place(const RenderScene& scene, uint32_t number, float u, float v) const;
  // What the place sends out in a direction.
  void radiance(const RenderScene& scene, uint32_t number, const Place& place, const float towards[3], Arena& arena,
                float out[3]) const;
  // The number of a shape, none if it is not among them.
  uint32_t find(uint32_t record, uint32_t primitive) const {
    const uint32_t first = firstOf_[record];
    return first == none ? none : first + primitive;
  }
  static constexpr uint32_t none = ~0u;

 private:
  void add(const RenderScene& scene, uint32_t record, std::vector<LightBounds>& bounds);
  std::vector<Shape> shapes_;     // all primitives of a record one after the other
  std::vector<uint32_t> firstOf_; // by record
  LightTree tree_;
  double brightest_ = 0;
};

// Corners of a record's triangle in render space.
void cornersOf(const struct Record& record, uint32_t primitive, float out[3][3]);

} // namespace openrt
