// planes.h: The planes that a Reconstruction computes with: one float per pixel, rows one after the
// other, with a border around the picture. Where light is followed in one pixel of each block only
// (RT_LIGHT_STRIDE), illumination has planes with one number per block: a grid of cells. The
// picture that is shown has planes of its own size, which may be larger than the frame. Filters
// read neighbours without testing whether they exist: the border is empty (Guides::name), so such
// neighbours get the weight 0. Rows can be written in whole vectors; what is written behind a row
// is part of the border. [any thread]
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace picture::live {

// Where a pixel lies in a plane.
struct Layout {
  // The widest filter reaches 2 * 16 pixels; vectors have at most 16 elements.
  static constexpr int border = 32, widest = 16;

  Layout() = default;
  Layout(int w, int h)
      : width(w), height(h), stride((size_t(w) + 2 * border + 2 * widest - 1) / widest * widest) {}

  size_t size() const { return stride * (size_t(height) + 2 * border); }
  // Offset of the first pixel of a row; rows from -border to height + border - 1 exist.
  size_t row(int y) const { return size_t(y + border) * stride + border; }
  bool operator==(const Layout&) const = default;

  int width = 0, height = 0;
  size_t stride = 0;
};

using Plane = std::vector<float>;

// Three planes: a colour as luma and two differences of colour, or a direction.
struct Plane3 {
  Plane x, y, z;
  void assign(size_t n, float value) {
    for (Plane* plane : {&x, &y, &z}) plane->assign(n, value);
  }
};

// Numbers in Guides::name that are no name.
constexpr float isGone = 2;       // in Guides::moves
constexpr float outsideName = -1; // the pixel does not exist
constexpr float emptyName = -2;   // the pixel has no sample

// Holds which surfaces pixels show.
struct Surfaces {
  void resize(const Layout& layout) {
    name.assign(layout.size(), outsideName);
    for (Plane* plane : {&nearness, &moves}) plane->assign(layout.size(), 0);
    normal.assign(layout.size(), 0);
  }

  Plane name;
  // Perspective: 1 / depth, since that is a linear function of the place in the picture on every
  // plane; 0: the environment. Parallel: depth / height of the view.
  Plane nearness;
  // 1: the surface has moved in the world since the frame before, or is new. isGone: it has
  // vanished in the frame after.
  Plane moves;
  Plane3 normal; // has the length 1
};

// Holds what is known about the surface that a pixel's first sample shows.
struct Guides : Surfaces {
  void resize(const Layout& layout) {
    Surfaces::resize(layout);
    for (Plane* plane : {&slopeX, &slopeY, &offsetX, &offsetY}) plane->assign(layout.size(), 0);
  }

  Plane slopeX, slopeY;   // change of nearness from pixel to pixel
  Plane offsetX, offsetY; // place of the sample relative to the pixel's centre, in pixels
};

// Holds what is accumulated over time for each pixel, or for each cell.
struct Accumulated {
  void resize(const Layout& layout) {
    for (Plane3* planes : {&light, &recent}) planes->assign(layout.size(), 0);
    for (Plane* plane : {&mean, &square, &frames, &noise}) plane->assign(layout.size(), 0);
  }

  Plane3 light;       // illumination: radiance / albedo; luma and colour differences
  Plane3 recent;      // the same over the last few frames only
  Plane mean, square; // means of the illumination's luma and of its square
  Plane frames;       // number of frames in `light`; 0: nothing is known
  Plane noise;        // 0 to 1: whether illumination was found to be noisy around here
};

// The illumination that a frame's pixels were shown with. The numbers of a pixel follow one
// another, so that places between pixels are read quickly.
struct ShownLight {
  void resize(const Layout& wanted) {
    layout = wanted;
    light.assign(layout.size() * 4, 0);
  }

  Layout layout;
  // Luma and colour differences; luma of the pixel's last sample, if cells have several pixels and
  // it has one.
  std::vector<float> light;
  static constexpr float noSample = -1;
};

// The picture that is shown, over time, and the surfaces that its pixels show. It is as large as
// the frame or larger: then it has more pixels than the frame has samples.
struct Shown {
  Shown() { resize(Layout(1, 1)); } // without a surface
  void resize(const Layout& wanted) {
    layout = wanted;
    colour.assign(layout.size() * 4, 0);
    level.assign(layout.size(), 0);
    surfaces.resize(layout);
  }

  Layout layout;
  // Red, green, blue, and the number of samples in them. Before the first sample a pixel has a
  // fraction of one, which those around it have lent.
  std::vector<float> colour;
  // Luma of the illumination that the colours are in, over the last frames; 0: unknown.
  Plane level;
  Surfaces surfaces;
};

// Maps pixels of a frame to pixels of another one that lie at the same place: pixel * ratio +
// shift, which is exactly the pixel if the sizes are equal.
struct Resampling {
  Resampling(int from, int to) : ratio(float(double(to) / from)), shift(0.5f * ratio - 0.5f) {}
  float operator()(float pixel) const { return pixel * ratio + shift; }
  float ratio, shift;
};

// Tells for each pixel of one axis of a picture which pixels of a frame that is no larger it
// overlaps: one or two.
struct Overlaps {
  Overlaps() = default;
  Overlaps(int frame, int picture);
  int frame = 0, picture = 0;
  // Vectors can be read beyond the end.
  std::vector<int32_t> first, last, middle; // middle: the one that has the pixel's centre
};

} // namespace picture::live
