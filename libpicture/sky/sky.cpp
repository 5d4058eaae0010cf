// sky.cpp: Draws skies. A sky is scaled to its integral, and the sun to the sum of its pixels, so
// that both give the illuminances that are asked for.
#include "libpicture/sky/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace picture {

namespace {

constexpr double pi = std::numbers::pi;

// A picture of all directions, its rows from the bottom up.
class Sphere {
 public:
  explicit Sphere(int rows) {
    image_.width = 2 * rows;
    image_.height = rows;
    image_.rgb.assign(size_t(image_.width) * size_t(rows) * 3, 0.0f);
  }
  int rows() const { return image_.height; }
  int columns() const { return image_.width; }
  // Returns the direction at a place, in pixels.
  Direction at(double column, double row) const {
    const double down = pi * (1 - row / rows()), turn = pi * (2 * column / columns() - 1);
    return {std::sin(down) * std::sin(turn), std::cos(down), -std::sin(down) * std::cos(turn)};
  }
  double solidAngle(int row) const {
    return pi / rows() * 2 * pi / columns() * std::sin(pi * (row + .5) / rows());
  }
  void add(int column, int row, double luminance) {
    float* pixel = &image_.rgb[3 * (size_t(row) * size_t(columns()) + size_t(column))];
    for (int c = 0; c < 3; ++c) pixel[c] += float(luminance);
  }
  xvrml::RadianceImage take() { return std::move(image_); }

 private:
  xvrml::RadianceImage image_;
};

// A pixel that the sun covers, and how much of it.
struct Pixel {
  int column, row;
  double share;
};

// Returns the pixels that the disc of the sun covers above the horizon.
std::vector<Pixel> pixelsOfSun(const Sphere& sphere, const Direction& sun) {
  constexpr double radius = .2665 * pi / 180; // seen from the earth at its mean distance
  constexpr int parts = 16;
  std::vector<Pixel> out;
  const double reach = radius + pi / sphere.rows();
  for (int row = sphere.rows() / 2; row < sphere.rows(); ++row) {
    if (std::abs(std::asin(std::clamp(sun[1], -1.0, 1.0)) -
                 pi * ((row + .5) / sphere.rows() - .5)) > reach)
      continue;
    for (int column = 0; column < sphere.columns(); ++column) {
      if (angleBetween(sphere.at(column + .5, row + .5), sun) > 2 * reach) continue;
      int inside = 0;
      for (int i = 0; i < parts * parts; ++i)
        inside += angleBetween(
                      sphere.at(column + (i % parts + .5) / parts, row + (i / parts + .5) / parts),
                      sun) < radius;
      if (inside > 0) out.push_back({column, row, double(inside) / (parts * parts)});
    }
  }
  return out;
}

void addSun(const Sky& sky, const Direction& sun, Sphere& sphere) {
  const std::vector<Pixel> pixels = pixelsOfSun(sphere, sun);
  double sum = 0;
  for (const Pixel& pixel : pixels) sum += pixel.share * sphere.solidAngle(pixel.row);
  for (const Pixel& pixel : pixels)
    sphere.add(pixel.column, pixel.row, sky.direct * pixel.share / sum);
}

} // namespace

double Sky::outdoors() const {
  return diffuse + direct * std::max(0.0, std::sin(sun.altitude * pi / 180));
}

std::string warningOf(const Sky& sky) {
  if (!sky.hasSet) return "";
  return fmt::format("the sun is not above the horizon (altitude {:.2f} degrees), so there is only "
                     "the light of the sky",
                     sky.sun.altitude);
}

// Pixels of the sky begin at the horizon, between two rows.
xvrml::RadianceImage pictureOf(const Sky& sky) {
  const bool shines = sky.direct > 0;
  Sphere sphere(shines ? 1024 : 256); // a sun is three pixels wide
  const Direction sun = directionOf(sky.sun, sky.north);
  const double scale = sky.diffuse / horizontalIlluminance(sky.luminance, sun);
  for (int row = 0; row < sphere.rows(); ++row)
    for (int column = 0; column < sphere.columns(); ++column) {
      const Direction d = sphere.at(column + .5, row + .5);
      sphere.add(column, row,
                 row < sphere.rows() / 2 ? sky.ground * sky.outdoors() / pi
                                         : scale * sky.luminance.at(d[1], angleBetween(d, sun)));
    }
  if (shines) addSun(sky, sun, sphere);
  return sphere.take();
}

} // namespace picture
