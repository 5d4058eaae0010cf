// placed_vertices.h: The vertices of a drawn shape in the coordinates of the world, for formats
// without a hierarchy and for the z-buffer renderer. [the thread that owns the world]
#pragma once

#include <array>

#include "libpicture/export/remarks.h"
#include "libpicture/export/vertices.h"
#include "libpicture/vec.h"
#include "xvrml/renderer.h"

namespace picture {

class PlacedVertices {
 public:
  // Counts in the remarks what is left out because its numbers are not finite.
  PlacedVertices(const xvrml::DrawnShape& shape, Remarks& remarks)
      : PlacedVertices(shape.mesh(), shape.matrix(), remarks) {}
  // arrays: must outlive the object. matrix: from them to the world, column by column.
  PlacedVertices(const xvrml::GeometryArrays& arrays, const double matrix[16], Remarks& remarks);
  const Vertices& local() const { return vertices_; }
  size_t size() const { return vertices_.size(); }
  Vec place(size_t i) const;          // where a vertex is
  xvrml::Vec3f point(size_t i) const; // the same in floats
  // Returns a vector of length 1. Without normals of the shape there is none.
  xvrml::Vec3f normal(size_t i) const;
  // Returns the corners of triangle t, counter-clockwise as seen from the front, also where the
  // matrix turns the world inside out.
  std::array<uint32_t, 3> triangle(size_t t) const;
  size_t triangles() const { return vertices_.indices().size() / 3; }
  // Returns the normal of a triangle; 0 0 0 if it has no area.
  xvrml::Vec3f faceNormal(size_t t) const;
  bool isFinite(size_t t) const; // false: a corner of triangle t is too far away for floats

 private:
  Vertices vertices_;
  std::array<double, 16> matrix_;
  Vec normals_[3]; // columns of the matrix for normals
  bool mirrors_ = false;
};

} // namespace picture
