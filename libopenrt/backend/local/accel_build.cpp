// accel_build.cpp: see accel_build.h. Objects placed once, or small ones, are baked into the root scene: no instance is met
// on the way to them, and packets of 16 stay whole. The rest become instances of scenes whose frame is scaled near 1, inside
// the band in which Embree's single precision is safe.
#include "backend/local/accel_build.h"

#include <cmath>

#include "backend/local/embree_parts.h"

namespace openrt {
namespace {

constexpr uint64_t bakedTriangles = 50000; // copies that are cheaper than an instance
constexpr size_t mergeBelow = 4096;        // triangles of a geometry that shares an Embree geometry with others
constexpr size_t mergedVertices = 8 << 20;

Matrix4d scaling(double s) {
  Matrix4d m;
  m.m[0] = m.m[5] = m.m[10] = s;
  return m;
}

bool similarity(const Matrix4d& m) {
  const Vec3d a = m.column(0), b = m.column(1), c = m.column(2);
  const double l = dot(a, a), e = 1e-6 * l;
  return std::fabs(dot(b, b) - l) <= e && std::fabs(dot(c, c) - l) <= e && std::fabs(dot(a, b)) <= e &&
         std::fabs(dot(a, c)) <= e && std::fabs(dot(b, c)) <= e;
}

// Inverse transpose up to a positive factor, its largest element 1: directions only.
void normalMatrixOf(const Matrix4d& m, float out[3][3]) {
  const Vec3d a = m.column(0), b = m.column(1), c = m.column(2);
  const Vec3d r[3] = {cross(b, c), cross(c, a), cross(a, b)}; // columns of the cofactor matrix
  double largest = 0;
  for (const Vec3d& v : r) largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  const double s = (m.determinant() < 0 ? -1 : 1) / (largest > 0 ? largest : 1);
  for (int j = 0; j < 3; j++) out[0][j] = float(r[j].x * s), out[1][j] = float(r[j].y * s), out[2][j] = float(r[j].z * s);
}

} // namespace

AccelBuilder::AccelBuilder(Accel& accel, const Scene& scene, const Flattened& flat, const ShaderTable& shaders,
                           const Vec3d& origin, const PixelFootprint& footprint)
    : accel_(accel), scene_(scene), flat_(flat), shaders_(shaders), origin_(origin), footprint_(footprint) {
  worldToRender_.translate(origin * -1.0);
}

void AccelBuilder::build() {
  surveyObjects();
  chooseScale();
  accel_.root_.scene = newScene(*accel_.device_);
  for (const Placement& placement : flat_.placements)
    if (baked(placement.object)) bakePlacement(placement);
  finish(accel_.root_, false);
  for (const Placement& placement : flat_.placements)
    if (!baked(placement.object)) instancePlacement(placement);
  finish(accel_.root_, true);
  if (accel_.buckets.empty()) accel_.buckets.push_back({shaders_[0].shaderClass, 0});
}

void AccelBuilder::surveyObjects() {
  for (const Placement& placement : flat_.placements) uses_[placement.object].placements++;
  for (auto& [id, use] : uses_) {
    for (const Geometry& g : scene_.objects.at(id).geometries) {
      use.bounds.add(boundsOf(g), Matrix4d());
      if (g.primitive == edit::Primitive::Triangles) use.triangles += g.primitives();
      if (g.primitive == edit::Primitive::Lines || g.primitive == edit::Primitive::Points) use.bakeOnly = true;
      if (g.primitive == edit::Primitive::Sphere && !similarity(g.matrix)) use.bakeOnly = true;
    }
    accel_.uniqueTriangles += use.triangles;
    accel_.triangles += use.triangles * use.placements;
  }
}

bool AccelBuilder::baked(uint32_t object) const {
  const Use& use = uses_.at(object);
  return use.bakeOnly || use.placements == 1 || use.triangles * (use.placements - 1) <= bakedTriangles;
}

void AccelBuilder::chooseScale() {
  Box world;
  for (const Placement& p : flat_.placements) world.add(uses_.at(p.object).bounds, p.matrix);
  if (world.empty()) return;
  accel_.radius = length(world.high - world.low) / 2;
  const Vec3d a = world.low - origin_, b = world.high - origin_;
  const double far = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z), std::fabs(b.x), std::fabs(b.y), std::fabs(b.z)});
  // Small scenes grow to about 1. Large ones shrink to the upper end of what the kernels do well (sizes of 1e-10 to 1e12), no
  // further: one thing put out of sight must not make everything else too small. Beyond 1e20 things are not drawn at all.
  const double target = far < 1e-4 ? 1.0 : 1e10;
  if (far > 0 && (far < 1e-4 || far > target))
    accel_.scale_ = float(std::exp2(std::floor(std::log2(target / std::min(far, 1e20)))));
}

uint32_t AccelBuilder::maskOf(uint32_t slot) const {
  return shaders_[slot].traits & RTS_TRANSPARENT ? maskTransparent : maskOpaque;
}

uint32_t AccelBuilder::bucketOf(uint32_t slot, uint32_t lightSet) {
  const auto key = std::make_pair(shaders_[slot].shaderClass, lightSet);
  const auto [found, fresh] = buckets_.try_emplace(key, uint32_t(accel_.buckets.size()));
  if (fresh) accel_.buckets.push_back({key.first, lightSet});
  return found->second;
}

// toRender: kernel's frame of an instance to render space; unused for what is baked.
uint32_t AccelBuilder::addRecord(const Placement& placement, const Geometry& g, const Matrix4d& toRender) {
  const bool instanced = !baked(placement.object);
  Record r;
  r.primitive = g.primitive;
  r.instanced = instanced;
  r.cull = g.cull;
  r.shader = shaders_.slotOf(placement.shader ? placement.shader : g.shader);
  r.bucket = bucketOf(r.shader, placement.lightSet);
  r.name = g.name ? g.name : placement.name, r.instance = placement.instance, r.userData = placement.userData;
  r.indices = g.indices ? g.indices->as<uint32_t>() : nullptr;
  r.normals = g.normals ? g.normals->as<float>() : nullptr;
  r.texCoords = g.texCoords ? g.texCoords->as<float>() : nullptr;
  r.colors = g.colors ? g.colors->as<float>() : nullptr;
  r.scale = 1 / accel_.scale_;
  const Matrix4d whole = worldToRender_ * placement.matrix * g.matrix;
  const bool mirrored = (instanced ? g.matrix : whole).determinant() < 0; // as the kernel sees the winding
  r.flip = g.primitive == edit::Primitive::Triangles && g.clockwise != mirrored;
  normalMatrixOf(whole, r.normalMatrix);
  if (instanced) {
    r.toRender = Affine::from(toRender);
    normalMatrixOf(toRender, r.kernelNormal);
  }
  if (g.primitive == edit::Primitive::Sphere) {
    const Matrix4d unit = whole * scaling(g.width);
    r.toRender = Affine::from(unit);
    r.fromRender = Affine::from(inverse(unit));
  }
  if (shaders_[r.shader].traits & RTS_TRANSPARENT) accel_.hasTransparent = true;
  accel_.records.push_back(r);
  return uint32_t(accel_.records.size() - 1);
}

void AccelBuilder::bakePlacement(const Placement& placement) {
  for (const Geometry& g : scene_.objects.at(placement.object).geometries) {
    const Matrix4d toKernel = scaling(accel_.scale_) * worldToRender_ * placement.matrix * g.matrix;
    if (!consistent(g) || !toKernel.usable()) continue;
    const uint32_t record = addRecord(placement, g, {});
    addGeometry(accel_.root_, g, toKernel, record, maskOf(accel_.records[record].shader));
  }
}

void AccelBuilder::instancePlacement(const Placement& placement) {
  Matrix4d fromKernel;
  const uint32_t index = objectScene(placement, fromKernel);
  const Matrix4d toRender = worldToRender_ * placement.matrix * fromKernel;
  const Matrix4d toRoot = scaling(accel_.scale_) * toRender;
  if (!toRoot.usable()) return;
  auto part = std::make_unique<Part>();
  part->objectScene = index;
  part->record = uint32_t(accel_.records.size());
  size_t i = 0;
  for (const Geometry& g : scene_.objects.at(placement.object).geometries) {
    const uint32_t record = addRecord(placement, g, toRender);
    accel_.records[record].vertices = objectVertices_[index][i++];
  }
  accel_.hasInstances = true;
  attachInstance(accel_.root_, *accel_.device_, std::move(part), *accel_.objectScenes_[index], toRoot);
}

// The scene of an object, its bounds scaled to about 1 around its centre; fromKernel leads back to the object's frame.
uint32_t AccelBuilder::objectScene(const Placement& placement, Matrix4d& fromKernel) {
  const int over = placement.shader ? int(maskOf(shaders_.slotOf(placement.shader))) : 0;
  const auto key = std::make_pair(placement.object, over);
  if (const auto found = objectScenes_.find(key); found != objectScenes_.end()) {
    fromKernel = found->second.second;
    return found->second.first;
  }
  const Box& box = uses_.at(placement.object).bounds;
  const Vec3d centre = (box.low + box.high) * 0.5, half = (box.high - box.low) * 0.5;
  const double size = std::max({half.x, half.y, half.z});
  fromKernel = scaling(size > 0 && std::isfinite(size) ? std::exp2(std::ceil(std::log2(size))) : 1.0);
  fromKernel.translate(centre);
  const Matrix4d toKernel = inverse(fromKernel);

  auto scene = std::make_unique<PartScene>();
  scene->scene = newScene(*accel_.device_);
  const auto& geometries = scene_.objects.at(placement.object).geometries;
  for (size_t i = 0; i < geometries.size(); i++) {
    const Matrix4d matrix = toKernel * geometries[i].matrix;
    if (!consistent(geometries[i]) || !matrix.usable()) continue;
    addGeometry(*scene, geometries[i], matrix, uint32_t(i),
                over ? uint32_t(over) : maskOf(shaders_.slotOf(geometries[i].shader)));
  }
  objectVertices_.emplace_back(geometries.size(), nullptr);
  finish(*scene, true);
  const uint32_t index = uint32_t(accel_.objectScenes_.size());
  accel_.objectScenes_.push_back(std::move(scene));
  objectScenes_[key] = {index, fromKernel};
  return index;
}

void AccelBuilder::addGeometry(PartScene& to, const Geometry& g, const Matrix4d& toKernel, uint32_t record, uint32_t mask) {
  switch (g.primitive) {
  case edit::Primitive::Triangles: addTriangles(to, g, toKernel, record, mask); break;
  case edit::Primitive::Sphere: addSphere(to, g, toKernel, record, mask); break;
  case edit::Primitive::Lines:
  case edit::Primitive::Points:
    accel_.hasThin = true;
    addThin(g, toKernel, record);
    break;
  }
}

void AccelBuilder::addTriangles(PartScene& to, const Geometry& g, const Matrix4d& toKernel, uint32_t record, uint32_t mask) {
  BakedTriangles baked = bakeTriangles(g, toKernel);
  accel_.degenerate += baked.degenerate;
  const bool whole = baked.indices.empty() && baked.slivers.empty() && baked.degenerate == 0;
  const size_t kept = whole ? g.primitives() : baked.kept.size();
  const uint32_t* index = g.indices->as<uint32_t>();
  if (!baked.slivers.empty()) merge(to, baked.vertices, index, &baked.slivers, 0, record, mask, true);
  if (kept < mergeBelow) {
    if (kept) merge(to, baked.vertices, index, whole ? nullptr : &baked.kept, kept, record, mask, false);
    return;
  }
  auto part = std::make_unique<Part>();
  part->vertices = std::move(baked.vertices);
  if (whole) {
    part->record = record;
    part->sharedIndices = g.indices;
  } else {
    part->recordOf.assign(kept, record);
    part->primitiveOf = std::move(baked.kept);
    part->indices = std::move(baked.indices);
  }
  vertexOf_.push_back({record, part.get(), 0});
  attachTriangles(to, *accel_.device_, std::move(part), mask, false);
}

// Triangles of `which` (null: the first count) join the merged geometry of their kind.
void AccelBuilder::merge(PartScene& to, const std::vector<float>& vertices, const uint32_t* index,
                         const std::vector<uint32_t>* which, size_t count, uint32_t record, uint32_t mask, bool filtered) {
  auto& part = merged_[{mask, filtered}];
  if (part && part->vertices.size() / 3 > mergedVertices) attachTriangles(to, *accel_.device_, std::move(part), mask, filtered);
  if (!part) part = std::make_unique<Part>();
  const uint32_t base = uint32_t(part->vertices.size() / 3);
  part->vertices.insert(part->vertices.end(), vertices.begin(), vertices.end());
  vertexOf_.push_back({record, part.get(), 3 * size_t(base)});
  if (which) count = which->size();
  for (size_t i = 0; i < count; i++) {
    const uint32_t t = which ? (*which)[i] : uint32_t(i);
    for (int k = 0; k < 3; k++) part->indices.push_back(base + index[3 * size_t(t) + k]);
    part->recordOf.push_back(record);
    part->primitiveOf.push_back(t);
  }
}

float AccelBuilder::pixelRadius(const float* p, float pixels) const {
  float depth = 0;
  for (int k = 0; k < 3; k++) depth += (p[k] / accel_.scale_ - footprint_.eye[k]) * footprint_.axis[k];
  return 0.5f * pixels * (footprint_.constant + footprint_.slope * std::fabs(depth)) * accel_.scale_;
}

// Round linear curves, or spheres for points, of `width` pixels as the camera sees them.
void AccelBuilder::addThin(const Geometry& g, const Matrix4d& toKernel, uint32_t record) {
  const std::vector<float> points = bakePoints(g, toKernel);
  const uint32_t* index = g.indices->as<uint32_t>();
  const bool lines = g.primitive == edit::Primitive::Lines;
  auto& part = lines ? curves_ : spheres_[maskThin];
  if (!part) part = std::make_unique<Part>();
  const auto put = [&](uint32_t i) {
    const float* p = points.data() + 3 * size_t(i);
    part->vertices.insert(part->vertices.end(), {p[0], p[1], p[2], pixelRadius(p, g.width)});
  };
  for (size_t i = 0; i < g.primitives(); i++) {
    if (lines) part->indices.push_back(uint32_t(part->vertices.size() / 4));
    put(index[lines ? 2 * i : i]);
    if (lines) put(index[2 * i + 1]);
    part->recordOf.push_back(record);
    part->primitiveOf.push_back(uint32_t(i));
  }
}

void AccelBuilder::addSphere(PartScene& to, const Geometry& g, const Matrix4d& toKernel, uint32_t record, uint32_t mask) {
  if (!similarity(toKernel)) { // an ellipsoid: an instance of the unit sphere
    auto part = std::make_unique<Part>();
    part->record = record;
    part->objectScene = unitSphere(mask);
    const PartScene& sphere = *accel_.objectScenes_[part->objectScene];
    accel_.hasInstances = true;
    attachInstance(to, *accel_.device_, std::move(part), sphere, toKernel * scaling(g.width));
    return;
  }
  auto& part = spheres_[mask];
  if (!part) part = std::make_unique<Part>();
  const Vec3d c = toKernel.translation();
  const float radius = float(g.width * length(toKernel.column(0)));
  part->vertices.insert(part->vertices.end(), {float(c.x), float(c.y), float(c.z), radius});
  part->recordOf.push_back(record);
  part->primitiveOf.push_back(0);
}

uint32_t AccelBuilder::unitSphere(uint32_t mask) {
  const auto key = std::make_pair(0u, int(mask));
  if (const auto found = objectScenes_.find(key); found != objectScenes_.end()) return found->second.first;
  auto scene = std::make_unique<PartScene>();
  scene->scene = newScene(*accel_.device_);
  auto part = std::make_unique<Part>();
  part->vertices = {0, 0, 0, 1};
  attachRound(*scene, *accel_.device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcCommitScene(scene->scene);
  objectVertices_.emplace_back();
  accel_.objectScenes_.push_back(std::move(scene));
  objectScenes_[key] = {uint32_t(accel_.objectScenes_.size() - 1), Matrix4d()};
  return objectScenes_[key].first;
}

// Attaches what was gathered for a scene; last: nothing more comes, so it is built. Vertices stay where they are from here on.
void AccelBuilder::finish(PartScene& to, bool last) {
  for (auto& [key, part] : merged_)
    if (part) attachTriangles(to, *accel_.device_, std::move(part), key.first, key.second);
  for (auto& [mask, part] : spheres_)
    if (part) attachRound(to, *accel_.device_, std::move(part), mask, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  if (curves_) attachRound(to, *accel_.device_, std::move(curves_), maskThin, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  merged_.clear();
  spheres_.clear();
  const bool root = &to == &accel_.root_;
  for (const VertexOf& v : vertexOf_) {
    const float* vertices = v.part->vertices.data() + v.offset;
    if (root)
      accel_.records[v.record].vertices = vertices;
    else
      objectVertices_.back()[v.record] = vertices;
  }
  vertexOf_.clear();
  if (last) rtcCommitScene(to.scene);
}

} // namespace openrt
