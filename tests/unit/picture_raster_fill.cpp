// picture_raster_fill.cpp: Tests which pixels the z-buffer draws triangles and lines in, against
// the edge rule and closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "libpicture/raster/fill.h"

namespace {

using namespace picture::raster;

constexpr int width = 40, height = 30;
constexpr double nearest = 1e30;

// A point at a place of the picture and a distance from the eye.
Corner at(double x, double y, double distance = 1) {
  return {float(x * distance), float(y * distance), float(distance), 1};
}

using Counts = std::vector<int>;

void add(const std::array<Corner, 3>& corners, Counts& counts) {
  const PixelBox box = Triangle::box(corners.data(), width, height);
  const Triangle triangle(corners.data(), nearest);
  for (int y = box.top; y <= box.bottom; ++y)
    triangle.row(y, box.left, box.right,
                 [&](int x, float) { ++counts[size_t(y) * width + size_t(x)]; });
}

Counts drawn(const std::array<Corner, 3>& corners) {
  Counts counts(size_t(width) * height);
  add(corners, counts);
  return counts;
}

// Returns the number of pixels that a row has from the left, in a picture of one triangle.
int pixelsOfRow(const Counts& counts, int y) {
  int sum = 0;
  for (int x = 0; x < width; ++x) sum += counts[size_t(y) * width + size_t(x)];
  return sum;
}

TEST(RasterFill, ATriangleHasThePixelsWhoseCentresLieInIt) {
  const Counts counts = drawn({at(5, 5), at(25, 5), at(5, 25)});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = x + 0.5 - 5, v = y + 0.5 - 5;
      if (u + v == 20) continue; // on the edge: the rule decides
      EXPECT_EQ(counts[size_t(y) * width + size_t(x)], u > 0 && v > 0 && u + v < 20 ? 1 : 0)
          << x << " " << y;
    }
}

TEST(RasterFill, ABackHasTheSamePixelsAsItsFront) {
  const std::array<Corner, 3> front = {at(3.2, 4.1), at(8.7, 27.3), at(31.9, 12.2)},
                              back = {front[0], front[2], front[1]};
  EXPECT_EQ(drawn(front), drawn(back));
  EXPECT_TRUE(Triangle::facesEye(front.data()));
  EXPECT_FALSE(Triangle::facesEye(back.data()));
}

// A net of triangles over the picture, with vertices in the middles of pixels and elsewhere, at
// other distances: each pixel is drawn once.
TEST(RasterFill, NeighboursLeaveNoGapsAndShareNoPixels) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.4, 0.4), distance(0.1, 10);
  for (int round = 0; round < 50; ++round) {
    constexpr int columns = 21, rows = 16, step = 2;
    std::vector<Corner> net;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const bool border = x == 0 || y == 0 || x == columns - 1 || y == rows - 1;
        const double dx = border           ? 0
                          : round % 3 == 0 ? 0.5
                                           : shift(random),
                     dy = border           ? 0
                          : round % 3 == 0 ? 0.5
                                           : shift(random);
        net.push_back(at(step * x + dx, step * y + dy, round % 2 ? distance(random) : 1));
      }
    Counts counts(size_t(width) * height);
    for (int y = 0; y + 1 < rows; ++y)
      for (int x = 0; x + 1 < columns; ++x) {
        const auto corner = [&](int i, int k) { return net[size_t((y + k) * columns + x + i)]; };
        add({corner(0, 0), corner(0, 1), corner(1, 1)}, counts);
        add({corner(0, 0), corner(1, 1), corner(1, 0)}, counts);
      }
    EXPECT_EQ(counts, Counts(size_t(width) * height, 1)) << round;
  }
}

TEST(RasterFill, DepthIsLinearInThePicture) {
  const std::array<Corner, 3> corners = {at(-10, -10, 1), at(80, -10, 4), at(-10, 80, 2)};
  const Triangle triangle(corners.data(), nearest);
  for (int y = 0; y < height; ++y)
    triangle.row(y, 0, width - 1, [&](int x, float depth) {
      const double u = (x + 0.5 + 10) / 90, v = (y + 0.5 + 10) / 90;
      EXPECT_NEAR(depth, 1 + u * (0.25 - 1) + v * (0.5 - 1), 1e-5);
    });
}

// Two corners are in front of the eye, one behind it: the part in front is drawn, to where its
// edges vanish.
TEST(RasterFill, TrianglesPassTheEyeWithoutClipping) {
  // Everything below the line y = 15 in the picture, as of a floor to the horizon.
  const std::array<Corner, 3> corners = {Corner{-1e4f, 15e4f, 1e4f, 1},
                                         Corner{1e4f, 15e4f, 1e4f, 1}, Corner{0, 1e4f, -100, 1}};
  const PixelBox box = Triangle::box(corners.data(), width, height);
  EXPECT_EQ(box.top, 0);
  EXPECT_EQ(box.bottom, height - 1);
  const Counts counts = drawn(corners);
  for (int y = 0; y < 15; ++y) EXPECT_EQ(pixelsOfRow(counts, y), 0) << y;
  EXPECT_GT(pixelsOfRow(counts, height - 1), 0);
}

TEST(RasterFill, UnusableTrianglesHaveNoPixels) {
  const float none = NAN, huge = INFINITY;
  for (const std::array<Corner, 3>& corners : {
           std::array<Corner, 3>{at(1, 1), at(9, 1), at(5, 1)},              // without an area
           std::array<Corner, 3>{at(1, 1), at(1, 1), at(1, 1)},              // a point
           std::array<Corner, 3>{at(1, 1), at(9, 1), Corner{none, 1, 1, 1}}, // a NaN
           std::array<Corner, 3>{at(1, 1), at(9, 1), Corner{1, huge, 1, 1}}, // infinite
           std::array<Corner, 3>{at(1, 1), at(9, 1), Corner{1, 1, none, 1}}, //
           std::array<Corner, 3>{at(1, 1, -1), at(9, 1, -1), at(1, 9, -1)},  // behind the eye
           std::array<Corner, 3>{Corner{}, Corner{}, Corner{}},              //
       })
    EXPECT_EQ(drawn(corners), Counts(size_t(width) * height));
}

TEST(RasterFill, HugeTrianglesCoverThePicture) {
  for (const float far : {1e10f, 1e20f, 1e30f}) {
    const std::array<Corner, 3> corners = {Corner{-far, -far, 1, 1}, Corner{far, -far, 1, 1},
                                           Corner{0, far, 1, 1}};
    EXPECT_EQ(drawn(corners), Counts(size_t(width) * height, 1)) << far;
  }
}

std::vector<std::array<int, 2>> pixelsOf(const Corner& from, const Corner& to) {
  const Corner ends[2] = {from, to};
  std::vector<std::array<int, 2>> pixels;
  if (const auto segment = clipped(ends, nearest, width, height))
    drawSegment(*segment, width, height, [&](int x, int y, float, double t) {
      pixels.push_back({x, y});
      EXPECT_TRUE(t >= 0 && t <= 1) << t;
    });
  return pixels;
}

TEST(RasterFill, LinesAreOnePixelWide) {
  const auto flat = pixelsOf(at(2.5, 10.5), at(12.5, 15.5));
  ASSERT_EQ(flat.size(), 11u);
  for (size_t i = 0; i < flat.size(); ++i) EXPECT_EQ(flat[i][0], int(2 + i));
  EXPECT_EQ(pixelsOf(at(7.5, 3.5), at(7.5, 9.5)).size(), 7u);
  EXPECT_EQ(pixelsOf(at(7.5, 3.5), at(7.5, 3.5)).size(), 1u); // a point
}

TEST(RasterFill, LinesAreClippedAtThePictureAndTheEye) {
  EXPECT_EQ(pixelsOf(at(-1000, 10.5), at(1000, 10.5)).size(), size_t(width));
  EXPECT_TRUE(pixelsOf(at(-10, -10), at(100, -10)).empty());
  EXPECT_TRUE(pixelsOf(at(5, 5, -1), at(9, 9, -2)).empty());
  // from the middle of the picture to a point behind the eye
  EXPECT_GE(pixelsOf(at(20, 15, 1), Corner{-50, -15, -1, 1}).size(), size_t(width / 2));
  EXPECT_TRUE(pixelsOf(Corner{NAN, 0, 1, 1}, at(1, 1)).empty());
  EXPECT_FALSE(pixelsOf(Corner{-1e30f, 15, 1, 1}, Corner{1e30f, 15, 1, 1}).empty());
}

// The middle of a line in the world is nearer to its far end in the picture.
TEST(RasterFill, PlacesOnLinesAreCorrectInPerspective) {
  const Corner ends[2] = {at(0.5, 10.5, 1), at(30.5, 10.5, 3)};
  const auto segment = clipped(ends, nearest, width, height);
  ASSERT_TRUE(segment);
  drawSegment(*segment, width, height, [&](int x, int, float, double t) {
    const double k = x / 30.0; // share in the picture
    EXPECT_NEAR(t, k / 3 / (k / 3 + 1 - k), 1e-5);
  });
}

} // namespace
