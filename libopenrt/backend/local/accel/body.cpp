// body.cpp: Small geometries share one Embree geometry, large ones have their own;
// slivers are met in double.
#include "backend/local/accel/body.h"

#include <algorithm>
#include <cmath>

#include "backend/local/accel/bake.h"
#include "backend/local/accel/survey.h"
#include "render/huge_spheres.h"

namespace openrt {
namespace {

constexpr size_t mergeBelow =
    4096; // triangles of a geometry that shares an Embree geometry with others
constexpr size_t mergedVertices = 8 << 20;

} // namespace

std::shared_ptr<const Body> UnitSpheres::get(uint32_t mask) {
  auto& known = spheres_[mask];
  if (known) return known;
  auto body = std::make_shared<Body>();
  body->scene = newScene(device_);
  auto part = std::make_unique<Part>();
  part->vertices = {0, 0, 0, 1};
  attachRound(*body, device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcCommitScene(body->scene);
  return known = std::move(body);
}

BodyBuilder::BodyBuilder(const EmbreeDevice& device, UnitSpheres& spheres, size_t entries)
    : device_(device), unitSpheres_(spheres), body_(std::make_shared<Body>()) {
  body_->scene = newScene(device);
  body_->vertices.resize(entries);
}

void BodyBuilder::add(const Geometry& g, const Matrix4d& toKernel, uint32_t entry, uint32_t mask) {
  if (!consistent(g) || !toKernel.usable()) return;
  if (g.primitive == edit::Primitive::Triangles) addTriangles(g, toKernel, entry, mask);
  if (g.primitive == edit::Primitive::Sphere) addSphere(g, toKernel, entry, mask);
}

void BodyBuilder::addInstance(std::shared_ptr<const Body> body, const Matrix4d& toKernel,
                              uint32_t entry) {
  if (!toKernel.usable() || body->parts.empty()) return;
  auto part = std::make_unique<Part>();
  part->record = entry;
  part->object = std::move(body);
  body_->instances = true;
  attachInstance(*body_, device_, std::move(part), toKernel);
}

void BodyBuilder::addTriangles(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                               uint32_t mask) {
  BakedTriangles baked = bakeTriangles(g, toKernel);
  body_->degenerate += baked.degenerate;
  const bool whole = baked.indices.empty() && baked.slivers.empty() && baked.degenerate == 0;
  const size_t kept = whole ? g.primitives() : baked.kept.size();
  const uint32_t* index = g.indices->as<uint32_t>();
  if (!baked.slivers.empty()) {
    Part& part = merge(baked.vertices, index, &baked.slivers, 0, entry, mask, true);
    part.openEdges.insert(part.openEdges.end(), baked.openEdges.begin(), baked.openEdges.end());
  }
  if (kept < mergeBelow) {
    if (kept) merge(baked.vertices, index, whole ? nullptr : &baked.kept, kept, entry, mask, false);
    return;
  }
  auto part = std::make_unique<Part>();
  part->vertices = std::move(baked.vertices);
  if (whole) {
    part->record = entry;
    part->sharedIndices = g.indices;
  } else {
    part->recordOf.assign(kept, entry);
    part->primitiveOf = std::move(baked.kept);
    part->indices = std::move(baked.indices);
  }
  vertexOf_.push_back({entry, part.get(), 0});
  attachTriangles(*body_, device_, std::move(part), mask, false);
}

// Triangles of `which` (null: the first count) join the merged geometry of their kind.
Part& BodyBuilder::merge(const std::vector<float>& vertices, const uint32_t* index,
                         const std::vector<uint32_t>* which, size_t count, uint32_t entry,
                         uint32_t mask, bool slivers) {
  auto& part = merged_[{mask, slivers}];
  if (part && part->vertices.size() / 3 > mergedVertices)
    attachTriangles(*body_, device_, std::move(part), mask, slivers);
  if (!part) part = std::make_unique<Part>();
  const uint32_t base = uint32_t(part->vertices.size() / 3);
  part->vertices.insert(part->vertices.end(), vertices.begin(), vertices.end());
  vertexOf_.push_back({entry, part.get(), 3 * size_t(base)});
  if (which) count = which->size();
  for (size_t i = 0; i < count; i++) {
    const uint32_t t = which ? (*which)[i] : uint32_t(i);
    for (int k = 0; k < 3; k++) part->indices.push_back(base + index[3 * size_t(t) + k]);
    part->recordOf.push_back(entry);
    part->primitiveOf.push_back(t);
  }
  return *part;
}

void BodyBuilder::addSphere(const Geometry& g, const Matrix4d& toKernel, uint32_t entry,
                            uint32_t mask) {
  const Matrix4d unit = toKernel * uniformScale(g.width);
  if (isHugeSphere(unit)) {
    auto& part = hugeSpheres_[mask];
    if (!part) part = std::make_unique<Part>();
    part->spheres.push_back(unit);
    part->recordOf.push_back(entry);
    part->primitiveOf.push_back(0);
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
  part->recordOf.push_back(entry);
  part->primitiveOf.push_back(0);
}

// Vertices stay where they are from here on.
std::shared_ptr<Body> BodyBuilder::finish() {
  for (auto& [key, part] : merged_)
    if (part) attachTriangles(*body_, device_, std::move(part), key.first, key.second);
  for (auto& [mask, part] : spheres_)
    if (part) attachRound(*body_, device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  for (auto& [mask, part] : hugeSpheres_)
    if (part) attachHugeSpheres(*body_, device_, std::move(part), mask);
  for (const VertexOf& v : vertexOf_) body_->vertices[v.entry] = v.part->vertices.data() + v.offset;
  rtcCommitScene(body_->scene);
  return std::move(body_);
}

Matrix4d kernelFrame(const Vec3d& low, const Vec3d& high) {
  const Vec3d half = (high - low) * 0.5;
  const double size = std::max({half.x, half.y, half.z});
  Matrix4d m =
      uniformScale(size > 0 && std::isfinite(size) ? std::exp2(std::ceil(std::log2(size))) : 1.0);
  if (size >= 0 && std::isfinite(size)) m.translate((low + high) * 0.5);
  return m;
}

} // namespace openrt
