// sliver_edges.cpp: classifies triangles by shape and finds shared edges. Called while baking.
#include "backend/local/sliver_edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "parallel_for.h"
#include "scene/matrix.h"

namespace openrt {
namespace {

// Height over longest edge of a sliver. In single precision the direction of a triangle's plane is
// wrong by up to 6e-8 divided by this ratio. A ray that starts nearer to the plane than about that
// fraction of the triangle's length may be found to start behind it. The bound was measured with
// 200,000 rays that started inside boxes of ratio 200 and 300, at a depth of more than 7e-6 of the
// length. With a bound of 1/250 three rays escaped; with 1/140 none did.
constexpr double sliverRatio = 1.0 / 128;
// Limits of the longest edge: its square times a distance of up to 1e17 must fit in a float.
constexpr double smallest = 1e-12, largest = 1e10;

constexpr uint32_t none = ~0u;

struct VertexKey {
  std::array<uint32_t, 3> bits;
  explicit VertexKey(const float* p) {
    for (size_t k = 0; k < 3; k++) bits[k] = std::bit_cast<uint32_t>(p[k] == 0 ? 0.0f : p[k]);
  }
  bool operator==(const VertexKey&) const = default;
};
struct VertexKeyHash {
  size_t operator()(const VertexKey& p) const {
    uint64_t h = p.bits[0] * 0x9e3779b97f4a7c15u;
    for (size_t k = 1; k < 3; k++) h = (h ^ (h >> 29) ^ p.bits[k]) * 0xbf58476d1ce4e5b9u;
    return size_t(h ^ (h >> 32));
  }
};

// The set of the edges of some triangles. Vertices at the same position have the same number.
class Edges {
 public:
  Edges(const std::vector<float>& vertices, const uint32_t* indices)
      : vertices_(vertices), indices_(indices) {}

  void add(size_t triangle) {
    uint32_t id[3];
    for (size_t k = 0; k < 3; k++)
      id[k] = ids_.try_emplace(VertexKey(at(indices_[3 * triangle + k])), uint32_t(ids_.size()))
                  .first->second;
    for (size_t k = 0; k < 3; k++) edges_.insert(key(id[k], id[(k + 1) % 3]));
  }
  // Looks up the number of every vertex, after all triangles are added. A table of bits, as in a
  // Bloom filter, rejects most vertices without a look-up.
  void lookUpVertices() {
    known_.assign(vertices_.size() / 3, none);
    std::vector<bool> some(std::bit_ceil(16 * ids_.size() + 1));
    const size_t mask = some.size() - 1;
    for (const auto& [place, id] : ids_) some[VertexKeyHash()(place) & mask] = true;
    forRanges(known_.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; i++) {
        const VertexKey place(at(uint32_t(i)));
        if (!some[VertexKeyHash()(place) & mask]) continue;
        if (const auto found = ids_.find(place); found != ids_.end()) known_[i] = found->second;
      }
    });
  }
  // Returns whether the edge from corner k of a triangle to the next corner is in the set. The
  // vertices must have been looked up.
  bool has(size_t triangle, size_t k) const {
    const uint32_t p = known_[indices_[3 * triangle + k]],
                   q = known_[indices_[3 * triangle + (k + 1) % 3]];
    return p != none && q != none && edges_.contains(key(p, q));
  }
  bool hasAny(size_t triangle) const {
    return has(triangle, 0) || has(triangle, 1) || has(triangle, 2);
  }

 private:
  const float* at(uint32_t index) const { return vertices_.data() + 3 * size_t(index); }
  static uint64_t key(uint32_t p, uint32_t q) {
    return uint64_t(std::min(p, q)) << 32 | std::max(p, q);
  }
  const std::vector<float>& vertices_;
  const uint32_t* indices_;
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> ids_;
  std::unordered_set<uint64_t> edges_;
  std::vector<uint32_t> known_; // by vertex
};

} // namespace

TriangleShape shapeOf(const float* a, const float* b, const float* c) {
  const Vec3d p(vectorOf(a)), e1 = Vec3d(vectorOf(b)) - p, e2 = Vec3d(vectorOf(c)) - p,
                              e3 = e2 - e1;
  const Vec3d n = cross(e1, e2);
  const double area = dot(n, n), longest = std::max({dot(e1, e1), dot(e2, e2), dot(e3, e3)});
  if (!(area > 0) || !std::isfinite(area)) return TriangleShape::degenerate;
  const bool extreme = longest < smallest * smallest || longest > largest * largest;
  return extreme || area < sliverRatio * sliverRatio * longest * longest ? TriangleShape::sliver
                                                                         : TriangleShape::good;
}

std::vector<uint8_t> widenSlivers(const std::vector<float>& vertices, const uint32_t* indices,
                                  std::vector<TriangleShape>& shapes) {
  const auto each = [&](TriangleShape shape, const auto& f) {
    for (size_t t = 0; t < shapes.size(); t++)
      if (shapes[t] == shape) f(t);
  };
  // Returns by triangle whether it is a good one that has an edge of the set.
  const auto touching = [&](const Edges& edges) {
    std::vector<uint8_t> touches(shapes.size());
    forRanges(shapes.size(), [&](size_t begin, size_t end) {
      for (size_t t = begin; t < end; t++)
        touches[t] = shapes[t] == TriangleShape::good && edges.hasAny(t);
    });
    return touches;
  };
  {
    Edges edges(vertices, indices);
    each(TriangleShape::sliver, [&](size_t t) { edges.add(t); });
    edges.lookUpVertices();
    const std::vector<uint8_t> touches = touching(edges);
    for (size_t t = 0; t < shapes.size(); t++)
      if (touches[t]) shapes[t] = TriangleShape::sliver;
  }
  Edges good(vertices, indices), slivers(vertices, indices);
  each(TriangleShape::sliver, [&](size_t t) { slivers.add(t); });
  slivers.lookUpVertices();
  const std::vector<uint8_t> touches = touching(slivers);
  for (size_t t = 0; t < shapes.size(); t++)
    if (touches[t]) good.add(t);
  good.lookUpVertices();
  std::vector<uint8_t> open;
  each(TriangleShape::sliver, [&](size_t t) { // in ray_triangle.h the edges are ac, ba, cb
    open.push_back(
        uint8_t((good.has(t, 2) ? 1 : 0) | (good.has(t, 0) ? 2 : 0) | (good.has(t, 1) ? 4 : 0)));
  });
  return open;
}

} // namespace openrt
