// emissive_shapes.h: area lights: triangles, spheres and surfaces of revolution with emission, and
// a light tree over them. Rebuilt between frames if transforms, shaders or textures have changed;
// read by all render threads.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lights/light_samples.h"
#include "render/lights/light_tree.h"

namespace openrt {

struct RenderScene;
class Arena;

class EmissiveShapes {
 public:
  struct Shape {
    uint32_t record, primitive;
    // 1: the side from which the corners turn counter-clockwise emits (the outside of a sphere, the
    // side of a surface's gradient); 2: the other side
    uint8_t sides;
    bool sphere;
    std::array<Vec3f, 3> corner; // triangle in render space, in the order of the kernel's normal
    bool swapped;                // corners 1 and 2 are the record's 2 and 1
    float power;                 // approximately proportional to the flux
    // Every point of a side emits the same radiance in all directions (RTS_UNIFORM_EMISSION).
    bool uniform = false;
    Vec3f radiance[2]; // mean emitted radiance of the sides, in the order of `sides`
    // The shape may be hidden, or have another surface in the same place: it counts only where rays
    // report it.
    bool uncertain = false;
    bool surface = false; // a quadric or an asphere (emissive_surfaces.h)
    bool curved() const { return sphere || surface; }
  };

  explicit EmissiveShapes(const RenderScene& scene);
  bool empty() const { return tree_.empty(); }
  size_t size() const { return shapes_.size(); }
  // Returns the largest mean radiance of a shape's side, summed over the colours.
  double brightest() const { return brightest_; }
  const Shape& operator[](uint32_t number) const { return shapes_[number]; }
  // Returns whether any shape is uncertain.
  bool anyUncertain() const { return anyUncertain_; }
  const LightTree& tree() const { return tree_; }
  // Returns the shapes as structure of arrays, for vector code.
  ShapeArrays arrays() const;
  // A point sampled on a shape. u, v: barycentric coordinates on a triangle. area: 1 / pdf by area,
  // which is the area of a triangle, and for a curved shape also corrects the uneven distribution
  // of points. It is 0 if the shape has no such point.
  struct Place {
    Vec3f position, normal;
    float u, v;
    double area;
  };
  // Samples a point of a shape. u, v: uniform in the unit square.
  Place place(const RenderScene& scene, uint32_t number, float u, float v) const;
  // Returns the radiance that a point emits in a direction. The shader is not called if the shape
  // emits uniformly.
  Vec3f radiance(const RenderScene& scene, uint32_t number, const Place& place,
                 const Vec3f& towards, Arena& arena) const;
  // Returns the number of a primitive's shape, or `none` if its record is not emissive.
  uint32_t find(uint32_t record, uint32_t primitive) const {
    const uint32_t first = firstOf_[record];
    return first == none ? none : first + primitive;
  }
  static constexpr uint32_t none = ~0u;

 private:
  void add(const RenderScene& scene, uint32_t record, std::vector<LightBounds>& bounds);
  void addSurface(const RenderScene& scene, uint32_t record, std::vector<LightBounds>& bounds);
  void markUncertain(const RenderScene& scene); // uncertain_shapes.cpp
  std::vector<Shape> shapes_;                   // all primitives of a record are consecutive
  std::vector<uint32_t> firstOf_;               // index of a record's first shape, by record
  LightTree tree_;
  std::vector<float> corners_[3][3]; // as Shape::corner, by shape
  std::vector<uint32_t> sides_;      // ShapeArrays::sides
  std::vector<float> radiance_[3];   // ShapeArrays::radiance
  bool anyUncertain_ = false;
  double brightest_ = 0;
};

// Returns a unit normal in render space as the kernel would return it for a triangle of the record.
Vec3f kernelNormal(const struct Record& record, const Vec3f& normal);

} // namespace openrt
