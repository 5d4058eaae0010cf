// outermost.h: Finds the points of a world that lie farthest out, in many directions. They stand
// for its hull where a camera is fitted: a round model is smaller than its bounding box. Owned by
// the mapper. [the mapper's thread]
#pragma once

#include <array>
#include <vector>

#include "geometry/matrix.h"

namespace xvrml::mapper {

class Outermost {
 public:
  static constexpr size_t count = 64; // directions; their opposites are looked at as well
  using Directions = std::array<Vector, count>;
  // Returns directions that cover a half sphere evenly. None of them is along an axis, so that of
  // the corners of a box each is found.
  static Directions even();

  explicit Outermost(const Directions& directions);
  // Takes a point into account; one that is not finite is left out.
  void add(const Vector& point);
  // Takes a sphere about 0 into account, transformed by `matrix`.
  void addSphere(const Matrix& matrix, double radius);
  // Returns the points that lie farthest out; empty if nothing was added. With even directions,
  // parts outside of their hull reach at most a few hundredths of its size beyond it.
  std::vector<Vector> points();

 private:
  void addBlock();
  bool mayBeOutside(const Vector& low, const Vector& high) const;
  void compare(const Vector& point);

  // The points that were added last. They are only looked at if their box reaches beyond what is
  // known: worlds have millions of points, and few of them lie far out.
  static constexpr size_t blockSize = 32;
  std::array<Vector, blockSize> block_;
  size_t inBlock_ = 0;
  std::array<double, count> x_, y_, z_; // the directions
  std::array<double, count> least_, most_;
  std::array<Vector, count> first_, last_; // the points there
};

} // namespace xvrml::mapper
