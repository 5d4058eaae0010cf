// exact_search.h: the search of ray queries whose crossings are decided exactly. It finds the
// surfaces that a ray may meet, and their triangles, by boxes (candidates.h). Each surface then
// decides which of them the ray crosses: those of an ExactScene for rays in render space, those of
// a DoubleScene for rays in double. Made between frames; then immutable. [any thread]
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "backend/local/accel/bake.h"
#include "backend/local/accel/candidates.h"
#include "backend/local/accel/crossing_collectors.h"

namespace openrt {

// Boxes of the triangles of a geometry, in a frame: vertex minus `center`, times `unit`.
struct MeshBoxes {
  Vec3d center, half; // the bounds, in the frame of the vertices
  double unit = 1;
  bool empty = true;                     // no triangle can be crossed
  std::unique_ptr<CandidateScene> boxes; // null if the triangles are few

  // spanOf(triangle, span): writes the bounds of a triangle; false: it can never be crossed.
  template <class SpanOf>
  MeshBoxes(const EmbreeDevice& device, uint32_t count, const SpanOf& spanOf) {
    Box bounds;
    Span span;
    for (uint32_t t = 0; t < count; t++) {
      if (!spanOf(t, span)) continue;
      bounds.add(span.low);
      bounds.add(span.high);
    }
    empty = bounds.empty();
    if (empty) return;
    center = (bounds.low + bounds.high) * 0.5;
    half = (bounds.high - bounds.low) * 0.5;
    unit = unitOf(largest(half));
    if (count <= fewTriangles) return;
    boxes = std::make_unique<CandidateScene>(device, count, [&](uint32_t t) {
      Span own;
      if (!spanOf(t, own)) return Span{{1, 1, 1}, {1, 1, 1}};
      return Span{(own.low - center) * unit, (own.high - center) * unit};
    });
  }
};

// Returns the box around a box that a matrix has placed.
inline Span placed(const Span& box, const Matrix4d& matrix) {
  const Vec3d reach = (box.high - box.low) * 0.5, middle = matrix.point((box.low + box.high) * 0.5);
  const Vec3d half = abs(matrix.column(0)) * reach.x + abs(matrix.column(1)) * reach.y +
                     abs(matrix.column(2)) * reach.z;
  return {middle - half, middle + half};
}

// Hits are in the order of t. The first of several at the same place wins, in whatever order they
// come.
template <class Hit> auto keyOf(const Hit& h) { return std::tuple(h.at.t, h.record, h.primitive); }

// A Surface is a placed geometry, and has the arithmetic:
//  - Ray, Hit, Mesh (with MeshBoxes, and a Key), Frame (with wayOf, which says how to search)
//  - record, box; mesh and analytic, of which spheres have none; frame, that of the mesh's boxes
//  - triangles(), the number of triangles; frameAround(center, unit), the frame of the surfaces
//  - meetTriangle, meetSphere and meetAnalytic, which add crossings to a collector
//  - withoutPlaces(ray), the ray for callers that do not ask where it crosses something
template <class Surface> class ExactSearch {
 public:
  using Ray = typename Surface::Ray;
  using Hit = typename Surface::Hit;
  using Mesh = typename Surface::Mesh;
  using Collector = CrossingCollector<Hit>;

  explicit ExactSearch(size_t records) : surfaceOf_(records, ~0u) {}

  // Returns the mesh of a key, each once, however often it is placed. former: a search that may
  // know it, or null. make: makes it.
  template <class Make> std::shared_ptr<const Mesh>
  mesh(const typename Mesh::Key& key, const ExactSearch* former, const Make& make) {
    std::shared_ptr<const Mesh>& mesh = meshes_[key];
    if (mesh) return mesh;
    if (former)
      if (const auto known = former->meshes_.find(key); known != former->meshes_.end())
        mesh = known->second;
    if (!mesh) mesh = make();
    return mesh;
  }

  void add(Surface surface) {
    surfaceOf_[surface.record] = uint32_t(surfaces_.size());
    surfaces_.push_back(std::move(surface));
  }

  // Makes the boxes of the surfaces. Call it once, after the last add().
  void makeBoxes(const EmbreeDevice& device) {
    if (surfaces_.size() <= fewSurfaces) return;
    Box bounds;
    for (const Surface& s : surfaces_) {
      bounds.add(s.box.low);
      bounds.add(s.box.high);
    }
    const Vec3d center = (bounds.low + bounds.high) * 0.5;
    const double unit = unitOf(largest(bounds.high - bounds.low) * 0.5);
    frame_ = Surface::frameAround(center, unit);
    boxes_ = std::make_unique<CandidateScene>(device, uint32_t(surfaces_.size()), [&](uint32_t i) {
      const Span& box = surfaces_[i].box;
      return Span{(box.low - center) * unit, (box.high - center) * unit};
    });
  }

  std::span<const Surface> surfaces() const { return surfaces_; }
  const Surface& surfaceOf(uint32_t record) const { return surfaces_[surfaceOf_[record]]; }

  // Adds the crossings of a ray that interest the collector.
  void find(const Ray& ray, Collector& to) const {
    const auto meetOne = [&](const Surface& surface) { return meet(surface, ray, to); };
    if (boxes_) {
      const auto way = frame_.wayOf(ray, ray.far);
      if (way.search == Search::none) return;
      if (way.search == Search::boxes)
        return visit(*boxes_, way, [&](uint32_t i) { return meetOne(surfaces_[i]); });
    }
    for (const Surface& surface : surfaces_)
      if (meetOne(surface) < ray.near) return;
  }

  bool occluded(const Ray& ray) const {
    AnyCrossing<Hit> found;
    find(Surface::withoutPlaces(ray), found);
    return found.met;
  }

  size_t count(const Ray& ray) const {
    CrossingCounter<Hit> found;
    find(Surface::withoutPlaces(ray), found);
    return found.count;
  }

  void all(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    AllCrossings<Hit> found(hits);
    find(ray, found);
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return keyOf(a) < keyOf(b); });
  }

 private:
  // Calls meet(box) for the boxes on the way of a ray.
  template <class Way, class Meet>
  static void visit(const CandidateScene& boxes, const Way& way, const Meet& meet) {
    struct Visitor final : CandidateVisitor {
      const Way& way;
      const Meet& meet;
      Visitor(const Way& w, const Meet& m) : way(w), meet(m) {}
      double visit(uint32_t box) override { return way.fromRay(meet(box)); }
    } visitor(way, meet);
    boxes.visit(way.ray, visitor);
  }

  double meet(const Surface& surface, const Ray& ray, Collector& to) const {
    if (surface.analytic) return surface.meetAnalytic(ray, to);
    return surface.mesh ? meetMesh(surface, ray, to) : surface.meetSphere(ray, to);
  }

  double meetMesh(const Surface& surface, const Ray& ray, Collector& to) const {
    const auto way = surface.frame.wayOf(ray, std::min(ray.far, to.far));
    if (way.search == Search::none) return to.far;
    if (way.search == Search::boxes && surface.mesh->boxes) {
      visit(*surface.mesh->boxes, way,
            [&](uint32_t t) { return surface.meetTriangle(t, ray, to); });
    } else {
      const uint32_t count = surface.triangles();
      for (uint32_t t = 0; t < count && to.far >= ray.near; t++) surface.meetTriangle(t, ray, to);
    }
    return to.far;
  }

  std::map<typename Mesh::Key, std::shared_ptr<const Mesh>> meshes_;
  std::vector<Surface> surfaces_;
  std::vector<uint32_t> surfaceOf_;       // by record
  typename Surface::Frame frame_;         // the frame of boxes_
  std::unique_ptr<CandidateScene> boxes_; // boxes of the surfaces; null if they are few
};

} // namespace openrt
