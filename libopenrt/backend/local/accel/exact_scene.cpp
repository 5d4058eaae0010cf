// exact_scene.cpp: builds and searches an ExactScene.
#include "backend/local/accel/exact_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "backend/local/accel/bake.h"
#include "backend/local/accel/survey.h"
#include "backend/local/ray_triangle.h"

namespace openrt {
namespace {

Vec3d cornerOf(const Record& r, uint32_t triangle, int k) { return Vec3d(r.corner(triangle, k)); }

// Embree drops such triangles too.
bool isInRange(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double most = largest(max(max(abs(a), abs(b)), abs(c)));
  return most <= 1e18 && std::isfinite(a.x + a.y + a.z + b.x + b.y + b.z + c.x + c.y + c.z);
}

// Returns a ray for callers that do not ask where it crosses something, but only whether. Its
// weights need no digits, but must be finite.
ExactRay withoutPlaces(const ExactRay& ray) {
  ExactRay out = ray;
  out.tolerance = 0x1p20;
  return out;
}

} // namespace

// The triangles of a geometry, in a frame of their own: vertex minus `center`, times `unit`.
struct ExactScene::Mesh {
  Vec3d center, half; // the bounds, in the frame of the vertices
  double unit = 1;
  std::unique_ptr<CandidateScene> boxes; // null if the triangles are few

  Mesh(const EmbreeDevice& device, const Record& r) {
    Box bounds;
    for (uint32_t t = 0; t < r.primitives; t++) {
      const Vec3d a = cornerOf(r, t, 0), b = cornerOf(r, t, 1), c = cornerOf(r, t, 2);
      if (!isInRange(a, b, c)) continue;
      bounds.add(a);
      bounds.add(b);
      bounds.add(c);
    }
    if (bounds.empty()) return;
    center = (bounds.low + bounds.high) * 0.5;
    half = (bounds.high - bounds.low) * 0.5;
    unit = unitOf(largest(half));
    if (r.primitives <= fewTriangles) return;
    boxes = std::make_unique<CandidateScene>(device, r.primitives, [&](uint32_t t) {
      const Vec3d a = cornerOf(r, t, 0), b = cornerOf(r, t, 1), c = cornerOf(r, t, 2);
      if (!isInRange(a, b, c)) return Span{{1, 1, 1}, {1, 1, 1}}; // is never crossed
      return Span{(min(min(a, b), c) - center) * unit, (max(max(a, b), c) - center) * unit};
    });
  }
};

// A placed geometry.
struct ExactScene::Surface {
  uint32_t record;
  const Mesh* mesh;                // null for spheres and analytic surfaces
  const AnalyticSurface* analytic; // null for the others
  // Render space -> the frame of the mesh, of the unit sphere or of the analytic surface:
  // inverse * (p - center).
  Vec3d center;
  Matrix4d inverse;
  Span box; // in render space

  FrameRay frameRay(const ExactRay& ray) const {
    return {inverse.direction(ray.origin - center), inverse.direction(ray.direction), ray.near,
            ray.far};
  }
};

class ExactScene::Nearest final : public Collector {
 public:
  Hit hit;
  double add(const Hit& h) override {
    // The first of several at the same place wins, in whatever order they come.
    const auto key = [](const Hit& x) { return std::tuple(x.at.t, x.record, x.primitive); };
    if (hit.record == noHit || key(h) < key(hit)) hit = h;
    return far = hit.at.t;
  }
};

class ExactScene::MeshVisitor final : public CandidateVisitor {
 public:
  MeshVisitor(const ExactScene& scene, const Surface& surface, const ExactRay& ray, Collector& to)
      : scene_(scene), surface_(surface), ray_(ray), to_(to) {}
  double visit(uint32_t triangle) override {
    return scene_.meetTriangle(surface_, triangle, ray_, to_);
  }

 private:
  const ExactScene& scene_;
  const Surface& surface_;
  const ExactRay& ray_;
  Collector& to_;
};

class ExactScene::TopVisitor final : public CandidateVisitor {
 public:
  TopVisitor(const ExactScene& scene, const ExactRay& ray, Collector& to)
      : scene_(scene), ray_(ray), to_(to) {}
  double visit(uint32_t surface) override {
    return scene_.meet(scene_.surfaces_[surface], ray_, to_);
  }

 private:
  const ExactScene& scene_;
  const ExactRay& ray_;
  Collector& to_;
};

std::shared_ptr<const ExactScene::Mesh>
ExactScene::meshOf(const EmbreeDevice& device, const Record& r, const ExactScene* former) {
  const Key key{r.vertices, r.indices, r.primitives};
  std::shared_ptr<const Mesh>& mesh = meshes_[key];
  if (mesh) return mesh;
  if (former)
    if (const auto known = former->meshes_.find(key); known != former->meshes_.end())
      mesh = known->second;
  if (!mesh) mesh = std::make_shared<const Mesh>(device, r);
  return mesh;
}

ExactScene::ExactScene(const EmbreeDevice& device, const Accel& accel, const ExactScene* former)
    : accel_(accel), owners_(accel.owners()), surfaceOf_(accel.records.size(), ~0u) {
  for (const Accel::Surface& from : accel.surfaces()) {
    const Record& r = accel.records[from.record];
    const bool triangles = r.primitive == edit::Primitive::Triangles;
    if (r.primitive != edit::Primitive::Sphere && r.instanced && !matrixOf(r.toRender).usable())
      continue; // Embree has it not
    const Mesh* mesh = triangles ? meshOf(device, r, former).get() : nullptr;
    Matrix4d toRender = !triangles    ? from.toRender
                        : r.instanced ? matrixOf(r.toRender)
                                      : uniformScale(r.scale);
    if (mesh) {
      Matrix4d shift = uniformScale(1 / mesh->unit);
      shift.translate(mesh->center);
      toRender = toRender * shift;
    }
    const double determinant = toRender.determinant();
    if (!toRender.finite() || determinant == 0 || !std::isfinite(1 / determinant)) continue;
    Span bounds{{-1, -1, -1}, {1, 1, 1}};
    if (mesh) bounds = {-mesh->half * mesh->unit, mesh->half * mesh->unit};
    if (r.surface) bounds = {r.surface->low(), r.surface->high()};
    const Vec3d reach = (bounds.high - bounds.low) * 0.5,
                middle = toRender.point((bounds.low + bounds.high) * 0.5);
    const Vec3d half = abs(toRender.column(0)) * reach.x + abs(toRender.column(1)) * reach.y +
                       abs(toRender.column(2)) * reach.z;
    surfaceOf_[from.record] = uint32_t(surfaces_.size());
    surfaces_.push_back({from.record,
                         mesh,
                         r.surface,
                         toRender.translation(),
                         inverse(toRender),
                         {middle - half, middle + half}});
  }
  makeTop(device);
}

ExactScene::~ExactScene() = default;

void ExactScene::makeTop(const EmbreeDevice& device) {
  if (surfaces_.size() <= fewSurfaces) return;
  Box bounds;
  for (const Surface& s : surfaces_) {
    bounds.add(s.box.low);
    bounds.add(s.box.high);
  }
  center_ = (bounds.low + bounds.high) * 0.5;
  unit_ = unitOf(largest(bounds.high - bounds.low) * 0.5);
  top_ = std::make_unique<CandidateScene>(device, uint32_t(surfaces_.size()), [&](uint32_t i) {
    const Span& box = surfaces_[i].box;
    return Span{(box.low - center_) * unit_, (box.high - center_) * unit_};
  });
}

void ExactScene::search(const ExactRay& ray, Collector& to) const {
  if (!top_) {
    for (const Surface& surface : surfaces_)
      if (meet(surface, ray, to) < ray.near) return;
    return;
  }
  TopVisitor visitor(*this, ray, to);
  top_->visit({(ray.origin - center_) * unit_, ray.direction * unit_, ray.near, ray.far}, visitor);
}

double ExactScene::meet(const Surface& surface, const ExactRay& ray, Collector& to) const {
  if (surface.analytic) return meetAnalytic(surface, ray, to);
  if (!surface.mesh) return meetSphere(surface, ray, to);
  FrameRay local = surface.frameRay(ray);
  local.far = std::min(local.far, to.far);
  double enter, leave;
  if (!(local.far >= local.near) || !clipToBall(local, enter, leave)) return to.far;
  if (surface.mesh->boxes) {
    MeshVisitor visitor(*this, surface, ray, to);
    surface.mesh->boxes->visit(local, visitor);
  } else {
    const uint32_t count = accel_.records[surface.record].primitives;
    for (uint32_t t = 0; t < count; t++) meetTriangle(surface, t, ray, to);
  }
  return to.far;
}

double ExactScene::meetTriangle(const Surface& surface, uint32_t triangle, const ExactRay& ray,
                                Collector& to) const {
  const Record& r = accel_.records[surface.record];
  const Vec3d a = cornerOf(r, triangle, 0), b = cornerOf(r, triangle, 1),
              c = cornerOf(r, triangle, 2);
  Hit hit{surface.record, triangle, {}};
  if (isInRange(a, b, c) && crosses(ray, r.placeOf(a), r.placeOf(b), r.placeOf(c), hit.at))
    return to.add(hit);
  return to.far;
}

// A ray that touches a sphere without entering it passes it.
double ExactScene::meetSphere(const Surface& surface, const ExactRay& ray, Collector& to) const {
  const FrameRay local = surface.frameRay(ray);
  double both[2];
  if (!intersectUnitSphere(local.origin, local.direction, both) || both[0] == both[1])
    return to.far;
  const double square = dot(local.direction, local.direction), reach = 1 + length(local.origin);
  for (const double t : both) {
    if (!(t > ray.near && t <= ray.far)) continue;
    const double half = (both[1] - both[0]) / 2,
                 error = 0x1p-49 * (reach / std::sqrt(square) + reach * reach / (half * square));
    to.add({surface.record, 0, {t, 0, 0, error, 0}});
  }
  return to.far;
}

double ExactScene::meetAnalytic(const Surface& surface, const ExactRay& ray, Collector& to) const {
  const FrameRay local = surface.frameRay(ray);
  const AnalyticSurface::Crossings found =
      surface.analytic->intersect(local.origin, local.direction);
  for (size_t i = 0; i < size_t(found.count); i++) {
    const double t = found.t[i];
    if (t > ray.near && t <= ray.far) to.add({surface.record, 0, {t}});
  }
  return to.far;
}

bool ExactScene::nearest(const ExactRay& ray, Hit& hit) const {
  Nearest found;
  search(ray, found);
  hit = found.hit;
  return hit.record != noHit;
}

bool ExactScene::occluded(const ExactRay& ray) const {
  AnyCrossing<Hit> found;
  search(withoutPlaces(ray), found);
  return found.met;
}

void ExactScene::all(const ExactRay& ray, std::vector<Hit>& hits) const {
  hits.clear();
  AllCrossings<Hit> found(hits);
  search(ray, found);
  const auto key = [](const Hit& h) { return std::tuple(h.at.t, h.record, h.primitive); };
  std::sort(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return key(a) < key(b); });
}

size_t ExactScene::count(const ExactRay& ray) const {
  CrossingCounter<Hit> found;
  search(withoutPlaces(ray), found);
  return found.count;
}

Vec3d ExactScene::point(const Hit& hit, const ExactRay& ray) const {
  const Record& r = accel_.records[hit.record];
  if (r.primitive != edit::Primitive::Triangles) return ray.origin + ray.direction * hit.at.t;
  const Vec3d a = r.placeOf(cornerOf(r, hit.primitive, 0));
  return a + (r.placeOf(cornerOf(r, hit.primitive, 1)) - a) * hit.at.u +
         (r.placeOf(cornerOf(r, hit.primitive, 2)) - a) * hit.at.v;
}

Vec3d ExactScene::normal(const Hit& hit, const ExactRay& ray) const {
  const Record& r = accel_.records[hit.record];
  Vec3d n;
  if (r.primitive != edit::Primitive::Triangles) {
    const Surface& surface = surfaces_[surfaceOf_[hit.record]];
    const FrameRay local = surface.frameRay(ray);
    n = local.origin + local.direction * hit.at.t;
    if (surface.analytic) {
      Vec3d gradient;
      surface.analytic->valueAt(n, gradient);
      n = normalize(gradient);
    }
    n = surface.inverse.transposed(n);
  } else {
    const Vec3d a = cornerOf(r, hit.primitive, 0);
    n = cross(cornerOf(r, hit.primitive, 1) - a, cornerOf(r, hit.primitive, 2) - a);
    if (r.instanced) n = r.kernelNormal * n;
  }
  if (r.flip) n = -n;
  const double l = length(n);
  return l > 0 ? n * (1 / l) : Vec3d{};
}

} // namespace openrt
