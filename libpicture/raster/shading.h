// shading.h: The colour of a visible point, by the lighting model of ISO/IEC 14772-1 (4.14).
// Normals, colours and texture coordinates are interpolated in the world, so that they are correct
// in perspective. [any thread]
#pragma once

#include "libpicture/raster/eye.h"
#include "libpicture/raster/mesh.h"
#include "libpicture/raster/textures.h"

namespace picture::raster {

class Shading {
 public:
  // Both must outlive the object.
  Shading(const Eye& eye, const Textures& textures) : eye_(eye), textures_(textures) {}
  // Returns the colour of a triangle in a pixel, whose centre is at x and y.
  xvrml::Color colorAt(const Mesh& mesh, size_t triangle, double x, double y) const;
  // Returns whether a triangle that lets light through is drawn in a pixel: the share of pixels
  // that it is drawn in is its opacity.
  bool coversPixel(const Mesh& mesh, size_t triangle, int x, int y) const;
  // Returns the colour of a line at a place from 0 to 1, or of a point.
  xvrml::Color colorOnLine(const Mesh& mesh, size_t first, size_t second, double t) const;

 private:
  struct Point;
  Point pointAt(const Mesh& mesh, size_t triangle, double x, double y) const;
  xvrml::Color lit(const Mesh& mesh, const Point& point, const xvrml::Color& diffuse) const;
  xvrml::Color seen(const Mesh& mesh, const xvrml::Color& color, const Vec& point) const;

  const Eye& eye_;
  const Textures& textures_;
};

} // namespace picture::raster
