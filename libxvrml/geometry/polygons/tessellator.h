// tessellator.h: triangulates polygons with any number of contours, concave or self-intersecting,
// with the GLU tessellator (which needs no OpenGL context). One object may serve many polygons, but
// only one thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vector_math.h"

struct GLUtesselator;

namespace xvrml {

class Tessellator {
 public:
  enum class Winding : uint8_t { odd, nonZero };
  // A vertex added where edges cross: a weighted mean of up to four earlier vertices.
  struct Crossing {
    V3d point;
    uint32_t from[4];
    double weight[4];
    uint32_t count;
  };

  Tessellator();
  ~Tessellator();
  Tessellator(const Tessellator&) = delete;
  Tessellator& operator=(const Tessellator&) = delete;

  // Begins a polygon. Vertices are numbered from 0 through all contours; crossings() continue the
  // numbers. Triangles are counterclockwise about `normal`.
  void begin(const V3d& normal, Winding winding);
  void contour(std::span<const V3d> points);
  bool end(); // false if GLU failed; triangles() is empty then

  // 3 vertex numbers per triangle
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  const std::vector<Crossing>& crossings() const { return crossings_; }

  // Called from the GLU callbacks.
  void addVertex(uint32_t vertex) { triangles_.push_back(vertex); }
  uint32_t addCrossing(const Crossing& crossing);
  void fail() { failed_ = true; }

 private:
  GLUtesselator* tess_;
  uint32_t vertices_ = 0;
  bool failed_ = false;
  std::vector<uint32_t> triangles_;
  std::vector<Crossing> crossings_;
};

// Axes that lay a polygon into a plane for the tessellator: x and y in the plane, z perpendicular.
// GLU sweeps along x and searches the crossed edges linearly, so the axes are turned by 90 degrees
// if that means less work.
class PlaneAxes {
 public:
  // Uses the coordinate plane that faces `normal` most, counterclockwise about it.
  explicit PlaneAxes(const V3d& normal);
  void turn() { turned_ = !turned_; }
  V3d toPlane(const V3d& p) const {
    return turned_ ? V3d(p[v_], -p[u_], p[w_]) : V3d(p[u_], p[v_], p[w_]);
  }
  V3d fromPlane(const V3d& p) const;

 private:
  int u_, v_, w_;
  bool turned_ = false;
};

// Returns how many edges the tessellator visits when it sweeps along `axis` (0: x, 1: y).
uint64_t sweepWork(std::span<const V3d> flatPolygon, int axis);

// Returns whether a flat polygon has more than `budget` crossings, or is too tangled to count them
// quickly. Tessellating it (quadratic in the worst case) would take too much time or memory.
bool isTangled(std::span<const V3d> flatPolygon, uint64_t budget);

// Returns whether two edges of a flat polygon, which is not tangled, clearly cross each other: by
// more than rounding and what programs that write outlines let pass.
bool crossesItself(std::span<const V3d> flatPolygon);

} // namespace xvrml
