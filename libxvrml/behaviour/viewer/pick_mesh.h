// pick_mesh.h: intersects a ray with one geometry node, in the node's own coordinate system. Large
// meshes have a bounding volume hierarchy, which is built where rays go: so the first ray waits for
// one path of it alone, and hits do not depend on the rays before. Used by the picker. [the
// browser's thread; one that nobody else has yet may be made and prepared on another]
#pragma once

#include <limits>

#include "geometry/half_space.h"
#include "geometry/matrix.h"
#include "geometry/mesh.h"

namespace xvrml {

struct PickBox {
  Vector low = Vector(std::numeric_limits<double>::infinity()),
         high = Vector(-std::numeric_limits<double>::infinity());
  bool empty() const { return !(low.x <= high.x); }
  void extend(const Vector& p);
  void extend(const PickBox& b);
  void extend(const PickBox& b, const Matrix& m); // extends by the transformed corners of b
  // Reduces the box to one around what of it lies in a half-space.
  void cut(const HalfSpace& halfSpace);
  // Grows the box to allow for rounding.
  void pad();
};

// The ray origin + t direction, t in [nearest, farthest]. The direction is not normalised, so t
// means the same in every coordinate system.
struct PickRay {
  Vector origin, direction;
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();

  Vector at(double t) const { return origin + direction * t; }
  bool intersects(const PickBox& box) const;
};

struct MeshHit {
  double t;
  Vector normal; // unit normal, towards the front side
  Vec2f texCoord;
};

class PickMesh {
 public:
  PickMesh(Node& geometry, const Limits* limits);
  // Builds the upper levels of the hierarchy, so that no ray waits for them, and copies what it has
  // used of the node, which may go then.
  void prepare();
  const PickBox& bounds() const { return bounds_; }
  // Finds the nearest hit. Back faces of solid geometry are ignored unless bothSides. Returns false
  // if nothing is hit.
  bool intersect(const PickRay& ray, bool bothSides, MeshHit& hit);

 private:
  // A box with two children at `next` and `next + 1`, or with triangles.
  struct BvhNode {
    enum class State : uint8_t {
      fresh,    // no ray has come: the box is not known
      splits,   // it has triangles, and is to be split once a ray meets the box
      remains,  // it has triangles
      hasHalves // it has children
    };
    uint32_t first = 0, count = 0, next = 0;
    uint8_t axis = 0; // along which it is split
    State state = State::fresh;
    PickBox box{};
  };
  void measure(BvhNode& bvhNode) const;
  void split(uint32_t number);
  bool sphere(const PickRay& ray, bool bothSides, MeshHit& hit) const;
  bool triangle(uint32_t index, PickRay& ray, bool bothSides, MeshHit& hit) const;
  Vector corner(uint32_t triangle, int k) const;

  Mesh mesh_;
  PickBox bounds_;
  std::vector<uint32_t> order_; // triangle numbers in the order of the leaves
  std::vector<BvhNode> bvh_;
};

} // namespace xvrml
