// tessellator.h: polygons with any number of contours, concave or self-crossing, to triangles, by
// the GLU tessellator (which needs no OpenGL context). One object may be used for many polygons;
// not shared between threads.
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
  // A vertex made where edges cross: a weighted mean of up to four earlier ones.
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

  // Vertices are numbered through all contours from 0; crossings() go on where they end. Triangles
  // turn counterclockwise about `normal`.
  void begin(const V3d& normal, Winding winding);
  void contour(std::span<const V3d> points);
  bool end(); // false if the library gave up: triangles() is empty then

  const std::vector<uint32_t>& triangles() const { return triangles_; } // 3 vertex numbers each
  const std::vector<Crossing>& crossings() const { return crossings_; }

  // For the library's callbacks.
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

// Polygons are given to the tessellator lying in a plane: x and y in the plane, z across. The
// tessellator sweeps along x and searches the edges it crosses one by one, so the plane is turned
// by a quarter where that means less work.
class PlaneAxes {
 public:
  // The coordinate plane that faces `normal` most, counterclockwise about it.
  explicit PlaneAxes(const V3d& normal);
  void turn() { turned_ = !turned_; }
  V3d into(const V3d& p) const {
    return turned_ ? V3d(p[v_], -p[u_], p[w_]) : V3d(p[u_], p[v_], p[w_]);
  }
  V3d outOf(const V3d& p) const;

 private:
  int u_, v_, w_;
  bool turned_ = false;
};

// How many edges the tessellator will look at when it sweeps along x (axis 0) or would along y
// (axis 1).
uint64_t sweepWork(std::span<const V3d> flatPolygon, int axis);

// True if a flat polygon crosses itself so often that tessellating it (quadratic in the worst case)
// would take too long or too much memory: more than `budget` crossings, or too tangled to tell
// quickly.
bool isTangled(std::span<const V3d> flatPolygon, uint64_t budget);

} // namespace xvrml
