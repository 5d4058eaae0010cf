// pick_mesh.h: what one ray meets of one geometry node, in the node's own coordinate system. Large
// meshes are searched through a tree of boxes. Made and asked by the picker. [the browser's thread]
#pragma once

#include <limits>

#include "geometry/matrix.h"
#include "geometry/mesh.h"

namespace xvrml {

struct PickBox {
  Vector low = Vector(std::numeric_limits<double>::infinity()),
         high = Vector(-std::numeric_limits<double>::infinity());
  bool empty() const { return !(low.x <= high.x); }
  void extend(const Vector& p);
  void extend(const PickBox& b);
  void extend(const PickBox& b, const Matrix& m); // the corners of b, moved
  // Grows by what rounding may take away.
  void pad();
};

// origin + t direction, t in [nearest, farthest]. The direction's length is free and stays: t means
// the same in every coordinate system.
struct PickRay {
  Vector origin, direction;
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();

  Vector at(double t) const { return origin + direction * t; }
  bool meets(const PickBox& box) const;
};

struct MeshHit {
  double t;
  Vector normal; // unit, towards the front side
  Vec2f texCoord;
};

class PickMesh {
 public:
  PickMesh(Node& geometry, const Limits* limits);
  const PickBox& bounds() const { return bounds_; }
  // The nearest hit; back faces of solid geometry are passed unless bothSides. False if there is
  // none.
  bool intersect(const PickRay& ray, bool bothSides, MeshHit& hit) const;

 private:
  struct Knot { // a box; its two parts follow at `next` and `next + 1`, or it holds triangles
    PickBox box;
    uint32_t first = 0, count = 0, next = 0; // count 0: has parts
  };
  void split();
  bool sphere(const PickRay& ray, bool bothSides, MeshHit& hit) const;
  bool triangle(uint32_t index, PickRay& ray, bool bothSides, MeshHit& hit) const;
  Vector corner(uint32_t triangle, int k) const;

  Mesh mesh_;
  PickBox bounds_;
  std::vector<uint32_t> order_; // of triangles, in the leaves
  std::vector<Knot> knots_;
};

} // namespace xvrml
