// blas.cpp: builds a Blas. Small geometries share one Embree geometry, large ones have their own.
// Slivers, huge spheres and analytic surfaces go to user geometries that intersect in double
// precision.
#include "backend/local/accel/blas.h"

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
  rtcCommitScene(blas->scene);
  return known = std::move(blas);
}

BlasBuilder::BlasBuilder(const EmbreeDevice& device, UnitSpheres& spheres, size_t entries)
    : device_(device), unitSpheres_(spheres), blas_(std::make_shared<Blas>()) {
  blas_->scene = newScene(device);
  blas_->vertices.resize(entries);
}

void BlasBuilder::add(const Geometry& g, const Matrix4d& toKernel, uint32_t entry, uint32_t mask) {
  if (!consistent(g) || !toKernel.usable()) return;
  if (g.primitive == edit::Primitive::Triangles) addTriangles(g, toKernel, entry, mask);
  if (g.primitive == edit::Primitive::Sphere) addSphere(g, toKernel, entry, mask);
  if (g.surface) addAnalytic(g, toKernel, entry, mask);
}

void BlasBuilder::addInstance(std::shared_ptr<const Blas> blas, const Matrix4d& toKernel,
                              uint32_t entry) {
  const double growth = growthOfInstance(toKernel);
  if (growth == 0 || blas->parts.empty()) return;
  blas_->instances = true;
  blas_->growth = std::max(blas_->growth, growth);
  attachInstance(*blas_, device_, std::move(blas), entry, toKernel);
}

void BlasBuilder::addTriangles(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                               uint32_t mask) {
  BakedTriangles baked = bakeTriangles(g, toKernel);
  blas_->degenerate += baked.degenerate;
  const bool whole = baked.indices.empty() && baked.slivers.empty() && baked.degenerate == 0;
  const size_t kept = whole ? g.primitives() : baked.kept.size();
  const uint32_t* index = g.indices->as<uint32_t>();
  if (!baked.slivers.empty()) mergeSlivers(baked, index, entry, mask);
  if (kept < mergeBelow) {
    if (kept) merge(baked.vertices, index, whole ? nullptr : &baked.kept, kept, entry, mask);
    return;
  }
  auto part = std::make_unique<Part>();
  part->vertices = std::move(baked.vertices);
  if (whole) {
    part->primitives.add(entry, 0, uint32_t(kept));
    part->sharedIndices = g.indices;
  } else {
    for (const uint32_t t : baked.kept) part->primitives.add(entry, t);
    part->indices = std::move(baked.indices);
  }
  triangles_ += kept;
  vertexOf_.push_back({entry, part.get(), 0});
  attachTriangles(*blas_, device_, std::move(part), mask, false);
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

// Attaches all parts that are still open and commits the scene. From here on the vertices keep
// their addresses.
std::shared_ptr<Blas> BlasBuilder::finish() {
  for (auto& [key, part] : merged_)
    if (part) attachTriangles(*blas_, device_, std::move(part), key.first, key.second);
  for (auto& [mask, part] : spheres_)
    if (part) attachRound(*blas_, device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  for (auto& [mask, part] : hugeSpheres_)
    if (part) attachHugeSpheres(*blas_, device_, std::move(part), mask);
  for (auto& [mask, part] : analytic_)
    if (part) attachAnalytic(*blas_, device_, std::move(part), mask);
  for (const VertexOf& v : vertexOf_) blas_->vertices[v.entry] = v.part->vertices.data() + v.offset;
  if (triangles_ >= compactTriangles) setCompact(blas_->scene);
  rtcCommitScene(blas_->scene);
  return std::move(blas_);
}

Matrix4d kernelFrame(const Vec3d& low, const Vec3d& high) {
  const Vec3d half = (high - low) * 0.5;
  const double size = largest(half);
  Matrix4d m =
      uniformScale(size > 0 && std::isfinite(size) ? std::exp2(std::ceil(std::log2(size))) : 1.0);
  if (size >= 0 && std::isfinite(size)) m.translate((low + high) * 0.5);
  return m;
}

} // namespace openrt
