// exact_scene.cpp: builds and searches an ExactScene.
#include "backend/local/accel/exact_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "backend/local/accel/exact_search.h"
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

// A frame that a matrix maps to render space: inverse * (p - center).
struct RenderFrame {
  Vec3d center;
  Matrix4d inverse;

  RenderFrame() = default;
  explicit RenderFrame(const Matrix4d& toRender)
      : center(toRender.translation()), inverse(openrt::inverse(toRender)) {}

  FrameRay rayOf(const ExactRay& ray) const {
    return {inverse.direction(ray.origin - center), inverse.direction(ray.direction), ray.near,
            ray.far};
  }
  // t is that of the ray in render space.
  struct Way {
    Search search;
    FrameRay ray;
    double fromRay(double t) const { return t; }
  };
  // far: as the ray's, or nearer.
  Way wayOf(const ExactRay& ray, double far) const {
    Way way{Search::none, rayOf(ray)};
    way.ray.far = far;
    double enter, leave;
    if (far >= ray.near && clipToBall(way.ray, enter, leave)) way.search = Search::boxes;
    return way;
  }
};

// Maps the frame in which everything lies within [-1, 1]^3: p minus `center`, times `unit`.
Matrix4d fromUnit(const Vec3d& center, double unit) {
  Matrix4d matrix = uniformScale(1 / unit);
  matrix.translate(center);
  return matrix;
}

} // namespace

struct ExactScene::Surface {
  using Ray = ExactRay;
  using Hit = ExactScene::Hit;
  using Collector = CrossingCollector<Hit>;
  using Frame = RenderFrame;
  struct Mesh : MeshBoxes {
    using Key = std::tuple<const float*, const uint32_t*, uint32_t>; // vertices, indices, number
    Mesh(const EmbreeDevice& device, const Record& r)
        : MeshBoxes(device, r.primitives, [&](uint32_t t, Span& span) {
            const Vec3d a = cornerOf(r, t, 0), b = cornerOf(r, t, 1), c = cornerOf(r, t, 2);
            span = {min(min(a, b), c), max(max(a, b), c)};
            return isInRange(a, b, c);
          }) {}
  };

  uint32_t record;
  const Record& source;
  std::shared_ptr<const Mesh> mesh; // null for spheres and analytic surfaces
  const AnalyticSurface* analytic;  // null for the others
  RenderFrame frame;                // that of the mesh, the unit sphere or the analytic surface
  Span box;                         // in render space

  static RenderFrame frameAround(const Vec3d& center, double unit) {
    return RenderFrame(fromUnit(center, unit));
  }
  // The weights of the ray need no digits, but must be finite.
  static ExactRay withoutPlaces(const ExactRay& ray) {
    ExactRay out = ray;
    out.tolerance = 0x1p20;
    return out;
  }
  uint32_t triangles() const { return source.primitives; }
  double meetTriangle(uint32_t triangle, const ExactRay& ray, Collector& to) const;
  double meetSphere(const ExactRay& ray, Collector& to) const;
  double meetAnalytic(const ExactRay& ray, Collector& to) const;
};

struct ExactScene::Surfaces : ExactSearch<Surface> {
  using ExactSearch::ExactSearch;
};

class ExactScene::Nearest final : public CrossingCollector<Hit> {
 public:
  Hit hit;
  double add(const Hit& h) override {
    if (hit.record == noHit || keyOf(h) < keyOf(hit)) hit = h;
    return far = hit.at.t;
  }
};

ExactScene::ExactScene(const EmbreeDevice& device, const Accel& accel, const ExactScene* former)
    : accel_(accel), owners_(accel.owners()),
      surfaces_(std::make_unique<Surfaces>(accel.records.size())) {
  for (const Accel::Surface& from : accel.surfaces()) {
    const Record& r = accel.records[from.record];
    const bool triangles = r.primitive == edit::Primitive::Triangles;
    if (r.primitive != edit::Primitive::Sphere && r.instanced &&
        !matrixOf(r.frames->toRender).usable())
      continue; // Embree has it not
    std::shared_ptr<const Surface::Mesh> mesh;
    Matrix4d toRender = from.toRender;
    Span bounds{{-1, -1, -1}, {1, 1, 1}};
    if (triangles) {
      mesh = surfaces_->mesh({r.vertices, r.indices, r.primitives},
                             former ? former->surfaces_.get() : nullptr,
                             [&] { return std::make_shared<const Surface::Mesh>(device, r); });
      if (mesh->empty) continue;
      toRender = (r.instanced ? matrixOf(r.frames->toRender) : uniformScale(r.scale)) *
                 fromUnit(mesh->center, mesh->unit);
      bounds = {-mesh->half * mesh->unit, mesh->half * mesh->unit};
    } else if (r.surface) {
      bounds = {r.surface->low(), r.surface->high()};
    }
    const double determinant = toRender.determinant();
    if (!toRender.finite() || determinant == 0 || !std::isfinite(1 / determinant)) continue;
    surfaces_->add({from.record, r, std::move(mesh), r.surface, RenderFrame(toRender),
                    placed(bounds, toRender)});
  }
  surfaces_->makeBoxes(device);
}

ExactScene::~ExactScene() = default;

double ExactScene::Surface::meetTriangle(uint32_t triangle, const ExactRay& ray,
                                         Collector& to) const {
  const Vec3d a = cornerOf(source, triangle, 0), b = cornerOf(source, triangle, 1),
              c = cornerOf(source, triangle, 2);
  Hit hit{record, triangle, {}};
  if (isInRange(a, b, c) &&
      crosses(ray, source.placeOf(a), source.placeOf(b), source.placeOf(c), hit.at))
    return to.add(hit);
  return to.far;
}

// A ray that touches a sphere without entering it passes it.
double ExactScene::Surface::meetSphere(const ExactRay& ray, Collector& to) const {
  const FrameRay local = frame.rayOf(ray);
  double both[2];
  if (!intersectUnitSphere(local.origin, local.direction, both) || both[0] == both[1])
    return to.far;
  const double square = dot(local.direction, local.direction), reach = 1 + length(local.origin);
  for (const double t : both) {
    if (!(t > ray.near && t <= ray.far)) continue;
    const double half = (both[1] - both[0]) / 2,
                 error = 0x1p-49 * (reach / std::sqrt(square) + reach * reach / (half * square));
    to.add({record, 0, {t, 0, 0, error, 0}});
  }
  return to.far;
}

double ExactScene::Surface::meetAnalytic(const ExactRay& ray, Collector& to) const {
  const FrameRay local = frame.rayOf(ray);
  const AnalyticSurface::Crossings found = analytic->intersect(local.origin, local.direction);
  for (size_t i = 0; i < size_t(found.count); i++) {
    const double t = found.t[i];
    if (t > ray.near && t <= ray.far) to.add({record, 0, {t}});
  }
  return to.far;
}

bool ExactScene::nearest(const ExactRay& ray, Hit& hit) const {
  Nearest found;
  surfaces_->find(ray, found);
  hit = found.hit;
  return hit.record != noHit;
}

bool ExactScene::occluded(const ExactRay& ray) const { return surfaces_->occluded(ray); }

void ExactScene::all(const ExactRay& ray, std::vector<Hit>& hits) const {
  surfaces_->all(ray, hits);
}

size_t ExactScene::count(const ExactRay& ray) const { return surfaces_->count(ray); }

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
    const Surface& surface = surfaces_->surfaceOf(hit.record);
    const FrameRay local = surface.frame.rayOf(ray);
    n = local.origin + local.direction * hit.at.t;
    if (surface.analytic) {
      Vec3d gradient;
      surface.analytic->valueAt(n, gradient);
      n = normalize(gradient);
    }
    n = surface.frame.inverse.transposed(n);
  } else {
    const Vec3d a = cornerOf(r, hit.primitive, 0);
    n = cross(cornerOf(r, hit.primitive, 1) - a, cornerOf(r, hit.primitive, 2) - a);
    if (r.instanced) n = r.frames->kernelNormal * n;
  }
  if (r.flip) n = -n;
  const double l = length(n);
  return l > 0 ? n * (1 / l) : Vec3d{};
}

} // namespace openrt
