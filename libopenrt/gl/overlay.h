// overlay.h: what lies over the picture: primitives under another projection than the camera's,
// with the colours of their materials and textures, without light. Each pixel has one sample, and
// what is drawn later covers what was drawn before.
#pragma once

#include <vector>

#include "gl/frame.h"
#include "gl/textures.h"

namespace rtgl {

class Overlay {
 public:
  Overlay(int width, int height);

  // How a part is drawn.
  struct Style {
    Matrix toWindow; // to pixels from the lower left corner of the picture; depths are -1 to 1
    std::array<double, 4> viewport; // x, y, width, height
    Polygon polygon;
    Material material;
    const Texture* texture = nullptr; // null: none
  };
  void draw(const Part& part, const Style& style);

  // Returns the colour of a pixel, multiplied by its alpha. Rows count from the top.
  const Color& at(int x, int y) const {
    return pixels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }

 private:
  struct Point;
  Point pointOf(const Vertex& vertex, const Style& style) const;
  void triangle(const Point& a, const Point& b, const Point& c, const Style& style);
  // Draws a parallelogram with two corners on both sides of each of a and b.
  void strip(const Point& a, const Point& b, double sideX, double sideY, const Style& style);
  void blend(int x, int y, const Point& at, const Style& style);

  int width_, height_;
  std::vector<Color> pixels_; // rows from the top
};

} // namespace rtgl
