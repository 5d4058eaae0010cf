// fill.h: Finds the pixels that a triangle or a line covers. Edges are evaluated in homogeneous
// coordinates (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997),
// so that triangles need no clipping where they pass the eye. [any thread]
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "libpicture/raster/eye.h"

namespace picture::raster {

// Rows and columns, the last ones included; empty if first > last.
struct PixelBox {
  int left = 0, right = -1, top = 0, bottom = -1;
  bool empty() const { return left > right || top > bottom; }
};

// An edge of a triangle: a x + b y + c is positive within, and 0 on the edge. Products of two
// floats are exact in double, so that triangles that share an edge get exactly opposite numbers.
struct Edge {
  double a = 0, b = 0, c = 0;
  // Returns whether the pixels whose centres lie on the edge belong to this triangle. They belong
  // to one of the two at the edge.
  bool owns() const { return a > 0 || (a == 0 && b > 0); }
  bool holds(double value) const { return value > 0 || (value == 0 && owns()); }
};

// A triangle that is ready to be drawn.
class Triangle {
 public:
  // Returns the pixels that a triangle may cover in a picture of this size. It is empty for
  // triangles without a pixel, without an area, and with numbers that are not finite.
  static PixelBox box(const Corner corners[3], int width, int height);
  // Returns whether corners that are counter-clockwise for the eye are seen, and not their back.
  static bool facesEye(const Corner corners[3]);

  // nearest: as of Eye.
  Triangle(const Corner corners[3], double nearest);

  // Calls draw(x, depth) for the pixels of a row, from left to right, within these columns.
  template <class Draw> void row(int y, int left, int right, const Draw& draw) const {
    const double v = y + 0.5;
    double rest[3], first = left, last = right;
    for (int i = 0; i < 3; ++i) {
      const Edge& edge = edges_[i];
      rest[i] = edge.b * v + edge.c;
      // The ends may be wrong by rounding; they are tested below.
      const double end = -rest[i] / edge.a - 0.5;
      if (edge.a > 0) first = std::max(first, std::ceil(end) - 1);
      if (edge.a < 0) last = std::min(last, std::floor(end) + 1);
    }
    if (!(first <= last)) return;
    const auto inside = [&](int x) {
      const double u = x + 0.5;
      return edges_[0].holds(edges_[0].a * u + rest[0]) &&
             edges_[1].holds(edges_[1].a * u + rest[1]) &&
             edges_[2].holds(edges_[2].a * u + rest[2]);
    };
    int from = int(first), to = int(last);
    while (from <= to && !inside(from)) ++from;
    while (to >= from && !inside(to)) --to;
    const double rowDepth = depth_.b * v + depth_.c;
    for (int x = from; x <= to; ++x) {
      const double d = std::clamp(depth_.a * (x + 0.5) + rowDepth, farthest_, closest_);
      if (d < nearest_) draw(x, float(d));
    }
  }

 private:
  Edge edges_[3], depth_;     // depth at x, y: a x + b y + c
  double farthest_, closest_; // depths of the corners
  double nearest_;
};

// A piece of a line in front of the eye and within the picture. Its ends are in pixels.
struct Segment {
  double x[2], y[2], d[2]; // d: depth
  double w[2];             // 1 / w is linear along the segment in the picture
  double t[2];             // places of the ends on the whole line: 0 at its first point
};
// Returns the part of a line that may be seen; none if there is none.
std::optional<Segment> clipped(const Corner ends[2], double nearest, int width, int height);

// Calls draw(x, y, depth, t) for the pixels of a segment, one in each column or row. t: the place
// on the whole line.
template <class Draw> void drawSegment(const Segment& s, int width, int height, const Draw& draw) {
  const double dx = s.x[1] - s.x[0], dy = s.y[1] - s.y[0];
  const bool flat = std::abs(dx) >= std::abs(dy);
  const int first = int(std::floor(flat ? s.x[0] : s.y[0])),
            last = int(std::floor(flat ? s.x[1] : s.y[1])), step = first <= last ? 1 : -1;
  for (int i = first;; i += step) {
    const double along = flat ? dx : dy, start = flat ? s.x[0] : s.y[0];
    const double k = along == 0 ? 0 : std::clamp((i + 0.5 - start) / along, 0.0, 1.0);
    const int x = flat ? i : int(std::floor(s.x[0] + k * dx)),
              y = flat ? int(std::floor(s.y[0] + k * dy)) : i;
    const double near = k / s.w[1], far = (1 - k) / s.w[0];
    if (x >= 0 && x < width && y >= 0 && y < height)
      draw(x, y, float(s.d[0] + k * (s.d[1] - s.d[0])),
           (far * s.t[0] + near * s.t[1]) / (far + near));
    if (i == last) break;
  }
}

} // namespace picture::raster
