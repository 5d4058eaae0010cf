// blas.cpp: builds a Blas. Small geometries share one Embree geometry, large ones have their own.
// Slivers, huge spheres and analytic surfaces go to user geometries that intersect in double
// precision.
#include "backend/local/accel/blas.h"

#include <algorithm>
#include <cmath>

#include "backend/local/accel/bake.h"
#include "backend/local/accel/survey.h"
#include "render/huge_spheres.h"

namespace openrt {
namespace {

// A geometry with fewer triangles shares an Embree geometry with others.
constexpr size_t mergeBelow = 4096;
constexpr size_t mergedVertices = 8 << 20; // a merged geometry with more vertices is closed
constexpr size_t mostPieces = 1 << 18;     // slivers beyond this number of pieces are not cut
// From this number of triangles on the Embree scene is compact: its leaves hold indices instead of
// vertices. 12 million triangles take 170 MB less, and 760 MB less while they are built; rays are
// as fast. Smaller scenes stay as they are, so that their pictures keep their bytes.
constexpr size_t compactTriangles = 1'000'000;

// Makes the part of a geometry that has an Embree geometry of its own, without its vertices.
std::unique_ptr<Part> partOf(const Geometry& g, BakedTriangles& baked, uint32_t entry) {
  auto part = std::make_unique<Part>();
  if (baked.whole()) {
    part->primitives.add(entry, 0, uint32_t(g.primitives()));
    part->sharedIndices = g.indices;
  } else {
    for (const uint32_t t : baked.kept) part->primitives.add(entry, t);
    part->indices = std::move(baked.indices);
  }
  return part;
}

// Returns points in a frame of their own, in which their size is near 1.
std::vector<float> verticesAtRest(const ArrayPtr& points) {
  Geometry resting;
  resting.points = points;
  const Box box = boundsOf(resting);
  return bakePoints(resting, inverse(kernelFrame(box.low, box.high)));
}

} // namespace

std::shared_ptr<const Blas> UnitSpheres::get(uint32_t mask) {
  auto& known = spheres_[mask];
  if (known) return known;
  auto blas = std::make_shared<Blas>();
  blas->scene = newScene(device_);
  auto part = std::make_unique<Part>();
  part->vertices = {0, 0, 0, 1};
  part->primitives.add(0, 0);
  attachRound(*blas, device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  device_.commit(blas->scene);
  return known = std::move(blas);
}

BlasBuilder::BlasBuilder(const EmbreeDevice& device, UnitSpheres& spheres, size_t entries,
                         double reach)
    : device_(device), unitSpheres_(spheres), reach_(reach), blas_(std::make_shared<Blas>()) {
  blas_->scene = newScene(device);
  blas_->vertices.resize(entries);
}

void BlasBuilder::add(const Geometry& g, const Matrix4d& toKernel, uint32_t entry, uint32_t mask) {
  if (!consistent(g) || !toKernel.usable()) return;
  if (g.primitive == edit::Primitive::Triangles)
    addTriangles(g, bakeTriangles(g, toKernel), entry, mask);
  if (g.primitive == edit::Primitive::Sphere) addSphere(g, toKernel, entry, mask);
  if (g.surface) addAnalytic(g, toKernel, entry, mask);
}

void BlasBuilder::addInstance(std::shared_ptr<const Blas> blas, const Matrix4d& toKernel,
                              uint32_t entry) {
  if (!isTraceable(toKernel, reach_) || blas->parts.empty()) return;
  blas_->instances = true;
  blas_->enlargement = std::max(blas_->enlargement, enlargementOf(toKernel));
  attachInstance(*blas_, device_, std::move(blas), entry, toKernel);
}

void BlasBuilder::addTriangles(const Geometry& g, BakedTriangles baked, uint32_t entry,
                               uint32_t mask) {
  blas_->degenerate += baked.degenerate;
  const bool whole = baked.whole();
  const size_t kept = whole ? g.primitives() : baked.kept.size();
  const uint32_t* index = g.indices->as<uint32_t>();
  if (!baked.slivers.empty()) mergeSlivers(baked, index, entry, mask);
  if (kept < mergeBelow) {
    if (kept) merge(baked.vertices, index, whole ? nullptr : &baked.kept, kept, entry, mask);
    return;
  }
  std::unique_ptr<Part> part = partOf(g, baked, entry);
  part->vertices = std::move(baked.vertices);
  triangles_ += kept;
  vertexOf_.push_back({entry, part.get(), 0});
  attachTriangles(*blas_, device_, std::move(part), mask, false);
}

bool Blas::Tree::operator==(const Tree& other) const {
  return mask == other.mask && slivers == other.slivers && kept == other.kept &&
         sameBytes(indices, other.indices) && sameBytes(rest, other.rest);
}

void BlasBuilder::addDeforming(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                               uint32_t mask, Blas* former) {
  if (!consistent(g) || !toKernel.usable()) return;
  BakedTriangles baked = bakeTriangles(g, toKernel);
  const size_t kept = baked.whole() ? g.primitives() : baked.kept.size();
  if (kept < mergeBelow) return addTriangles(g, std::move(baked), entry, mask);
  blas_->degenerate += baked.degenerate;
  blas_->tree = {g.rest ? g.rest : g.points, g.indices, baked.kept, mask, !baked.slivers.empty()};
  triangles_ += kept;
  if (!baked.slivers.empty()) mergeSlivers(baked, g.indices->as<uint32_t>(), entry, mask);
  if (former && former->tree == blas_->tree) {
    takeOver(*former, std::move(baked.vertices));
  } else {
    std::unique_ptr<Part> part = partOf(g, baked, entry);
    part->vertices = verticesAtRest(blas_->tree->rest);
    setDeforming(blas_->scene);
    attachTriangles(*blas_, device_, std::move(part), mask, false, true);
    deformed_ = std::move(baked.vertices);
  }
  vertexOf_.push_back({entry, blas_->parts[0].part.get(), 0});
}

// Takes the scene and the tree of a former state of the same mesh. The vertices of then stay with
// it, because queries may know them by their address.
void BlasBuilder::takeOver(Blas& former, std::vector<float> vertices) {
  std::swap(blas_->scene, former.scene);
  former.tree.reset();
  blas_->refitted = true;
  auto part = std::make_unique<Part>();
  Part& before = *former.parts[0].part;
  part->primitives = std::move(before.primitives);
  part->indices = std::move(before.indices);
  part->sharedIndices = std::move(before.sharedIndices);
  for (uint32_t slot = 1; slot < former.parts.size(); slot++) rtcDetachGeometry(blas_->scene, slot);
  blas_->parts.emplace_back().part = std::move(part);
  setVertices(*blas_, 0, std::move(vertices));
}

// Appends the vertices of an entry to the merged geometry of a kind. base: the number that their
// first one gets.
Part& BlasBuilder::extend(const std::vector<float>& vertices, uint32_t entry, uint32_t mask,
                          bool slivers, uint32_t& base) {
  auto& part = merged_[{mask, slivers}];
  if (part && part->vertices.size() / 3 > mergedVertices)
    attachTriangles(*blas_, device_, std::move(part), mask, slivers);
  if (!part) part = std::make_unique<Part>();
  base = uint32_t(part->vertices.size() / 3);
  part->vertices.insert(part->vertices.end(), vertices.begin(), vertices.end());
  vertexOf_.push_back({entry, part.get(), 3 * size_t(base)});
  return *part;
}

// Adds the triangles in `which` (null: the first `count`) to the merged geometry.
void BlasBuilder::merge(const std::vector<float>& vertices, const uint32_t* index,
                        const std::vector<uint32_t>* which, size_t count, uint32_t entry,
                        uint32_t mask) {
  uint32_t base;
  Part& part = extend(vertices, entry, mask, false, base);
  triangles_ += count;
  for (size_t i = 0; i < count; i++) {
    const uint32_t t = which ? (*which)[i] : uint32_t(i);
    for (int k = 0; k < 3; k++) part.indices.push_back(base + index[3 * size_t(t) + k]);
    part.primitives.add(entry, t);
  }
}

// Adds the pieces of the slivers to the merged geometry of slivers.
void BlasBuilder::mergeSlivers(const BakedTriangles& baked, const uint32_t* index, uint32_t entry,
                               uint32_t mask) {
  uint32_t base;
  Part& part = extend(baked.vertices, entry, mask, true, base);
  triangles_ += baked.slivers.size();
  for (size_t i = 0; i < baked.slivers.size(); i++) {
    const uint32_t t = baked.slivers[i], *corner = index + 3 * size_t(t);
    const auto place = [&](int k) {
      return Vec3d(vectorOf(&baked.vertices[3 * size_t(corner[k])]));
    };
    const bool full = part.pieces.size() >= mostPieces;
    const uint8_t count = full ? 1 : countPieces(place(0), place(1), place(2));
    for (uint8_t piece = 0; piece < count; piece++) {
      for (int k = 0; k < 3; k++) part.indices.push_back(base + corner[k]);
      part.primitives.add(entry, t);
      part.openEdges.push_back(baked.openEdges[i]);
      part.pieces.push_back({piece, count});
    }
  }
}

void BlasBuilder::addSphere(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                            uint32_t mask) {
  const Matrix4d unit = toKernel * uniformScale(g.width);
  if (isHugeSphere(unit)) {
    auto& part = hugeSpheres_[mask];
    if (!part) part = std::make_unique<Part>();
    part->spheres.push_back(unit);
    part->primitives.add(entry, 0);
    return;
  }
  if (!similarity(toKernel)) {
    addInstance(unitSpheres_.get(mask), unit, entry);
    return;
  }
  auto& part = spheres_[mask];
  if (!part) part = std::make_unique<Part>();
  const Vec3d c = toKernel.translation();
  const float radius = float(g.width * length(toKernel.column(0)));
  part->vertices.insert(part->vertices.end(), {float(c.x), float(c.y), float(c.z), radius});
  part->primitives.add(entry, 0);
}

void BlasBuilder::addAnalytic(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                              uint32_t mask) {
  auto& part = analytic_[mask];
  if (!part) part = std::make_unique<Part>();
  part->surfaces.push_back({g.surface, toKernel, inverse(toKernel)});
  part->primitives.add(entry, 0);
}

// Attaches all parts that are still open and commits the scene. At the end the vertices have the
// addresses that they keep.
std::shared_ptr<Blas> BlasBuilder::finish() {
  for (auto& [key, part] : merged_)
    if (part) attachTriangles(*blas_, device_, std::move(part), key.first, key.second);
  for (auto& [mask, part] : spheres_)
    if (part) attachRound(*blas_, device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  for (auto& [mask, part] : hugeSpheres_)
    if (part) attachHugeSpheres(*blas_, device_, std::move(part), mask);
  for (auto& [mask, part] : analytic_)
    if (part) attachAnalytic(*blas_, device_, std::move(part), mask);
  if (triangles_ >= compactTriangles) setCompact(blas_->scene);
  device_.commit(blas_->scene);
  if (!deformed_.empty()) {
    setVertices(*blas_, 0, std::move(deformed_));
    device_.commit(blas_->scene);
  }
  for (const VertexOf& v : vertexOf_) blas_->vertices[v.entry] = v.part->vertices.data() + v.offset;
  return std::move(blas_);
}

Matrix4d kernelFrame(const Vec3d& low, const Vec3d& high, const std::optional<Vec3d>& origin) {
  const Vec3d half = (high - low) * 0.5;
  const double size = largest(half);
  Matrix4d m =
      uniformScale(size > 0 && std::isfinite(size) ? std::exp2(std::ceil(std::log2(size))) : 1.0);
  if (size >= 0 && std::isfinite(size)) m.translate(origin.value_or((low + high) * 0.5));
  return m;
}

} // namespace openrt
