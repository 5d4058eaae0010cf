// vertices.h: The vertices and indices of a drawn shape, made fit for files: every number is
// finite, normals have the length 1, triangles are counter-clockwise as seen from the front. Arrays
// that are fit already are not copied. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "xvrml/build.h"

namespace picture {

inline float between0And1(float v) { return v > 0 ? (v < 1 ? v : 1.0f) : 0.0f; } // NaN: 0

class Vertices {
 public:
  // arrays: must outlive the object, and have no Kind::sphere. Triangles, lines and points with a
  // vertex that is not finite, or not there, are left out.
  explicit Vertices(const xvrml::GeometryArrays& arrays);

  size_t size() const { return kept_.empty() ? arrays_.points.size() : kept_.size(); }
  std::span<const uint32_t> indices() const { return indices_; }
  bool empty() const { return indices_.empty(); }
  bool hasNormals() const { return !arrays_.normals.empty(); }
  bool hasColors() const { return !arrays_.colors.empty(); }
  bool hasAlphas() const { return !arrays_.alphas.empty(); }
  xvrml::Vec3f point(size_t i) const { return arrays_.points[place(i)]; }
  // Returns a vector of length 1, also for a normal without a length.
  xvrml::Vec3f normal(size_t i) const;
  // Returns numbers of the file, from 0 to 1.
  xvrml::Color color(size_t i) const;
  float alpha(size_t i) const { return between0And1(arrays_.alphas[place(i)]); }
  xvrml::Vec2f texCoord(size_t i) const;
  size_t leftOut() const { return leftOut_; } // triangles, lines and points

 private:
  size_t place(size_t i) const { return kept_.empty() ? i : kept_[i]; }
  void keepGood(size_t corners);

  const xvrml::GeometryArrays& arrays_;
  std::span<const uint32_t> indices_;
  std::vector<uint32_t> ownIndices_;
  std::vector<uint32_t> kept_; // places of the vertices in the arrays; empty: all
  size_t leftOut_ = 0;
};

// Returns how many indices a triangle, line or point has; 0 for other kinds.
size_t cornersOf(xvrml::GeometryArrays::Kind kind);

} // namespace picture
