#include "libpicture/export/vertices.h"

#include <algorithm>
#include <cmath>

namespace picture {

using xvrml::GeometryArrays;
using xvrml::Vec3f;

namespace {

bool isFinite(const Vec3f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

} // namespace

size_t cornersOf(GeometryArrays::Kind kind) {
  switch (kind) {
  case GeometryArrays::Kind::triangles: return 3;
  case GeometryArrays::Kind::lines: return 2;
  case GeometryArrays::Kind::points: return 1;
  default: return 0;
  }
}

Vertices::Vertices(const GeometryArrays& arrays) : arrays_(arrays) {
  const size_t corners = cornersOf(arrays.kind);
  if (corners == 0) return;
  const size_t count = arrays.points.size();
  const bool good = arrays.indices.size() % corners == 0 &&
                    std::all_of(arrays.points.begin(), arrays.points.end(), isFinite) &&
                    std::all_of(arrays.indices.begin(), arrays.indices.end(),
                                [&](uint32_t i) { return i < count; });
  indices_ = arrays.indices;
  if (!good) keepGood(corners);
  if (arrays.ccw || corners != 3 || indices_.empty()) return;
  if (ownIndices_.empty()) ownIndices_.assign(indices_.begin(), indices_.end());
  for (size_t i = 0; i + 2 < ownIndices_.size(); i += 3)
    std::swap(ownIndices_[i + 1], ownIndices_[i + 2]);
  indices_ = ownIndices_;
}

// Keeps what has good vertices alone, and only these vertices.
void Vertices::keepGood(size_t corners) {
  constexpr uint32_t none = ~0u;
  std::vector<uint32_t> places(arrays_.points.size(), none); // new places of vertices
  for (size_t i = 0; i < arrays_.indices.size(); i += corners) {
    const auto first = arrays_.indices.begin() + ptrdiff_t(i);
    const bool whole = i + corners <= arrays_.indices.size();
    if (!whole || !std::all_of(first, first + ptrdiff_t(corners), [&](uint32_t v) {
          return v < arrays_.points.size() && isFinite(arrays_.points[v]);
        })) {
      ++leftOut_;
      continue;
    }
    for (size_t k = 0; k < corners; ++k) {
      uint32_t& place = places[first[ptrdiff_t(k)]];
      if (place == none) {
        place = uint32_t(kept_.size());
        kept_.push_back(first[ptrdiff_t(k)]);
      }
      ownIndices_.push_back(place);
    }
  }
  indices_ = ownIndices_;
}

Vec3f Vertices::normal(size_t i) const {
  const Vec3f& n = arrays_.normals[place(i)];
  const double length = std::hypot(double(n.x), double(n.y), double(n.z));
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 1};
  return {float(n.x / length), float(n.y / length), float(n.z / length)};
}

xvrml::Color Vertices::color(size_t i) const {
  const xvrml::Color& c = arrays_.colors[place(i)];
  return {between0And1(c.r), between0And1(c.g), between0And1(c.b)};
}

xvrml::Vec2f Vertices::texCoord(size_t i) const {
  if (arrays_.texCoords.empty()) return {};
  const xvrml::Vec2f& uv = arrays_.texCoords[place(i)];
  return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : xvrml::Vec2f{};
}

} // namespace picture
