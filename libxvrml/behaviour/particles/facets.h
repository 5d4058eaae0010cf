// facets.h: the triangles of a geometry that particles leave or bounce off. Any thread.
#pragma once

#include <array>
#include <vector>

#include "behaviour/particles/draws.h"
#include "xvrml/nodes.h"

namespace xvrml {

struct Facet {
  std::array<V3d, 3> corners;
  std::array<V3d, 3> normals; // unit vectors at the corners, towards the front
  V3d normal;                 // unit vector of the plane, towards the front
};

class Facets {
 public:
  static constexpr uint64_t most = 1'000'000; // facets of one geometry

  Facets() = default;
  // geometry: may be null. Lines and points have no facets.
  explicit Facets(Node* geometry);

  struct Point {
    V3d place, normal;
  };
  // Returns a point of a surface that has facets, evenly over its area.
  Point draw(Draws& draws) const;
  // Returns a point within the surface, evenly over its volume. If none is found, as in a surface
  // without a volume, it is one of the surface.
  V3d drawWithin(Draws& draws) const;

  const std::vector<Facet>& all() const { return all_; }
  bool empty() const { return all_.empty(); }
  bool twoSided() const { return twoSided_; }

 private:
  void add(const std::array<V3d, 3>& corners, const std::array<V3d, 3>& normals);
  bool isInside(const V3d& point) const;

  std::vector<Facet> all_;
  std::vector<double> areas_; // sums of the areas up to each facet
  V3d low_{0, 0, 0}, high_{0, 0, 0};
  bool twoSided_ = false;
};

// Returns the facets of the faces that are given by coordinates and their indices.
Facets facetsOfFaces(const NodeRef& coord, const MFInt32& coordIndex);

} // namespace xvrml
