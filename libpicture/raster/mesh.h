// mesh.h: A shape that is being drawn: its vertices in the world and in the picture, and its look.
// [made on the thread that owns the world; read on any thread]
#pragma once

#include <algorithm>
#include <vector>

#include "libpicture/export/placed_vertices.h"
#include "libpicture/export/surface.h"
#include "libpicture/raster/eye.h"
#include "libpicture/raster/lamps.h"
#include "libpicture/raster/surroundings.h"

namespace picture::raster {

// The look of a shape. Colours are linear, or numbers of the file where the picture is not linear.
struct Look {
  Surface surface;
  float ambient = 0; // share of the ambient light that the surface reflects
  bool linear = true;
  const Haze* haze = nullptr; // the fog in front of it; null: none

  // Returns whether a pixel of a face may show what is behind it.
  bool letsThrough() const { return surface.alpha != Surface::Alpha::opaque; }
};

struct Mesh {
  Mesh(xvrml::GeometryArrays given, const double matrix[16], Look seen, Remarks& remarks)
      : arrays(std::move(given)), vertices(arrays, matrix, remarks), look(std::move(seen)) {}
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  const xvrml::GeometryArrays arrays;
  const PlacedVertices vertices;
  const Look look;
  std::vector<const Lamp*> lamps; // those that shine on it
  std::vector<Corner> corners;    // the vertices in the picture
  uint32_t number = 0;            // shapes with other numbers let other pixels through

  // Returns the number of triangles, lines or points.
  size_t size() const {
    return vertices.local().indices().size() / std::max<size_t>(1, cornersOf(arrays.kind));
  }
  uint32_t index(size_t i) const { return vertices.local().indices()[i]; }
};

} // namespace picture::raster
