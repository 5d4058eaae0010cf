// double_scene.cpp: builds and searches a DoubleScene.
#include "backend/local/double/double_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "backend/local/accel/exact_search.h"
#include "backend/local/double/search_frame.h"

namespace openrt {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Larger coordinates are dropped, as by Embree.
constexpr float farthest = 1e18f;

} // namespace

struct DoubleScene::Surface {
  using Ray = DoubleRay;
  using Hit = DoubleScene::Hit;
  using Collector = CrossingCollector<Hit>;
  using Frame = SearchFrame;

  struct Corners { // vertices of triangles, as they are stored
    ArrayPtr points, indices;
    uint32_t count = 0;

    explicit Corners(const Geometry& g)
        : points(g.points), indices(g.indices),
          count(consistent(g) ? uint32_t(g.primitives()) : 0) {}
    Vec3f corner(uint32_t triangle, size_t k) const {
      return vectorOf(points->as<float>() + 3 * size_t(indices->as<uint32_t>()[3 * triangle + k]));
    }
    bool isInRange(uint32_t t) const {
      return largest(max(max(abs(corner(t, 0)), abs(corner(t, 1))), abs(corner(t, 2)))) <= farthest;
    }
    bool spanOf(uint32_t t, Span& span) const {
      const Vec3d a(corner(t, 0)), b(corner(t, 1)), c(corner(t, 2));
      span = {min(min(a, b), c), max(max(a, b), c)};
      return isInRange(t);
    }
  };
  struct Mesh : Corners, MeshBoxes {
    using Key = std::pair<const Array*, const Array*>; // points and indices
    Mesh(const EmbreeDevice& device, const Geometry& g)
        : Corners(g),
          MeshBoxes(device, count, [this](uint32_t t, Span& span) { return spanOf(t, span); }) {}
  };

  uint32_t record;
  std::shared_ptr<const Mesh> mesh;                // null for spheres and analytic surfaces
  std::shared_ptr<const AnalyticSurface> analytic; // null for the others
  double radius;                                   // the radius of a sphere
  bool clockwise;
  Matrix4d world, inverse; // from the frame of the vertices to the world, and back
  SearchFrame frame;       // the frame of the mesh's boxes
  Span box;                // in the world

  static SearchFrame frameAround(const Vec3d& center, double unit) {
    return SearchFrame(Matrix4d(), center, unit);
  }
  static const DoubleRay& withoutPlaces(const DoubleRay& ray) { return ray; }
  uint32_t triangles() const { return mesh->count; }
  PlacedTriangle triangle(uint32_t t) const {
    return {mesh->corner(t, 0), mesh->corner(t, 1), mesh->corner(t, 2), world};
  }
  double meetTriangle(uint32_t triangle, const DoubleRay& ray, Collector& to) const;
  double meetSphere(const DoubleRay& ray, Collector& to) const;
  double meetAnalytic(const DoubleRay& ray, Collector& to) const;
};

struct DoubleScene::Surfaces : ExactSearch<Surface> {
  using ExactSearch::ExactSearch;
};

// The least t that any other crossing may truly have is `others`.
class DoubleScene::Nearest final : public CrossingCollector<Hit> {
 public:
  Hit hit;
  double others = infinite;
  double add(const Hit& h) override {
    Hit other = h;
    if (hit.record == noHit || keyOf(h) < keyOf(hit)) std::swap(hit, other);
    if (other.record != noHit) others = std::min(others, other.at.t - other.at.tError);
    return far = hit.at.t + hit.at.tError;
  }
};

DoubleScene::DoubleScene(const EmbreeDevice& device, const Input& input, const DoubleScene* former)
    : surfaces_(std::make_unique<Surfaces>(input.accel.records.size())) {
  for (uint32_t c = 0; c < input.flat.clusters.size(); c++)
    if (c == 0 || input.flat.clusters[c].visible) addSurfaces(device, input, c, former);
  surfaces_->makeBoxes(device);
}

DoubleScene::~DoubleScene() = default;

// Adds what a cluster shows, with the matrices that accel_records.cpp uses, but in the world.
void DoubleScene::addSurfaces(const EmbreeDevice& device, const Input& input, uint32_t number,
                              const DoubleScene* former) {
  const Cluster& cluster = input.flat.clusters[number];
  const PartInfo& info = input.survey.parts()[cluster.part];
  const std::vector<Item>& items = input.flat.parts[cluster.part].items;
  for (size_t i = 0; i < items.size(); i++) {
    const auto& geometries = input.scene.objects.at(items[i].object).geometries;
    const Matrix4d world = cluster.world * items[i].matrix;
    for (size_t k = 0; k < geometries.size(); k++) {
      const uint32_t record = input.accel.firstRecord(number) + info.firstEntry[i] + uint32_t(k);
      addSurface(device, geometries[k], world * geometries[k].matrix, record, former);
    }
  }
}

void DoubleScene::addSurface(const EmbreeDevice& device, const Geometry& g, const Matrix4d& world,
                             uint32_t record, const DoubleScene* former) {
  const bool triangles = g.primitive == edit::Primitive::Triangles,
             sphere = g.primitive == edit::Primitive::Sphere;
  if (!(triangles || sphere || g.surface) || !world.usable()) return;
  if (sphere && !consistent(g)) return;
  Surface s{record,         nullptr, g.surface, double(g.width), g.clockwise, world,
            inverse(world), {},      {}};
  Span bounds{Vec3d{-1, -1, -1} * s.radius, Vec3d{1, 1, 1} * s.radius};
  if (triangles) {
    // The arrays of a mesh live as long as the mesh, so equal addresses mean the same arrays.
    s.mesh = surfaces_->mesh({g.points.get(), g.indices.get()},
                             former ? former->surfaces_.get() : nullptr,
                             [&] { return std::make_shared<const Surface::Mesh>(device, g); });
    if (s.mesh->empty) return;
    bounds = {s.mesh->center - s.mesh->half, s.mesh->center + s.mesh->half};
    s.frame = SearchFrame(world, s.mesh->center, s.mesh->unit);
  } else if (s.analytic) {
    bounds = {s.analytic->low(), s.analytic->high()};
  }
  s.box = placed(bounds, world);
  surfaces_->add(std::move(s));
}

double DoubleScene::Surface::meetTriangle(uint32_t number, const DoubleRay& ray,
                                          Collector& to) const {
  Hit hit{record, number, {}};
  if (mesh->isInRange(number) && crosses(ray, triangle(number), hit.at)) return to.add(hit);
  return to.far;
}

double DoubleScene::Surface::meetSphere(const DoubleRay& ray, Collector& to) const {
  CrossingPoint found[2];
  const int count = crossSphere(ray, world, radius, found);
  for (int i = 0; i < count; i++) to.add({record, 0, found[i]});
  return to.far;
}

double DoubleScene::Surface::meetAnalytic(const DoubleRay& ray, Collector& to) const {
  const Vec3d from = ray.origin - world.translation();
  const AnalyticSurface::Crossings found =
      analytic->intersect(inverse.direction(from), inverse.direction(ray.direction));
  for (size_t i = 0; i < size_t(found.count); i++) {
    const double t = found.t[i];
    if (t > ray.near && t <= ray.far)
      to.add({record, 0, {t, 0, 0, analyticError(ray, world, *analytic, t), 0}});
  }
  return to.far;
}

bool DoubleScene::nearest(const DoubleRay& ray, Hit& hit) const {
  Nearest found;
  surfaces_->find(ray, found);
  hit = found.hit;
  if (hit.record == noHit) return false;
  // The true first crossing is not before the least of all.
  hit.ambiguous = found.others <= hit.at.t + hit.at.tError;
  hit.at.tError = std::max(hit.at.tError, (hit.at.t - found.others) * (1 + 0x1p-50));
  return true;
}

bool DoubleScene::occluded(const DoubleRay& ray) const { return surfaces_->occluded(ray); }

void DoubleScene::all(const DoubleRay& ray, std::vector<Hit>& hits) const {
  surfaces_->all(ray, hits);
}

size_t DoubleScene::count(const DoubleRay& ray) const { return surfaces_->count(ray); }

DoublePlace DoubleScene::place(const Hit& hit, const DoubleRay& ray) const {
  const Surface& surface = surfaces_->surfaceOf(hit.record);
  const DoublePlace onRay = placeOnRay(ray, hit.at);
  if (!surface.mesh || hit.ambiguous) return onRay;
  const DoublePlace onTriangle = placeOnTriangle(surface.triangle(hit.primitive), hit.at);
  return onTriangle.error < onRay.error ? onTriangle : onRay;
}

Vec3d DoubleScene::normal(const Hit& hit, const DoubleRay& ray) const {
  return normalAt(surfaces_->surfaceOf(hit.record), hit.primitive, ray.at(hit.at.t));
}

// Mirrored triangles keep their front side: their corners run clockwise in the world.
Vec3d DoubleScene::normalAt(const Surface& surface, uint32_t primitive, const Vec3d& place) const {
  Vec3d n;
  if (surface.mesh) {
    const PlacedTriangle s = surface.triangle(primitive);
    n = cross(Vec3d(s.b) - Vec3d(s.a), Vec3d(s.c) - Vec3d(s.a));
  } else {
    n = surface.inverse.direction(place - surface.world.translation());
    if (surface.analytic) {
      Vec3d gradient;
      surface.analytic->valueAt(n, gradient);
      n = gradient;
    }
  }
  n = surface.inverse.transposed(normalize(n));
  return normalize(surface.clockwise && (surface.mesh || surface.analytic) ? -n : n);
}

// Collects the closest place. The least distance that any other may truly have is `others`.
class DoubleScene::ClosestVisitor final : public CandidateVisitor {
 public:
  const Vec3d point;
  const Surface* surface = nullptr; // whose triangles are visited
  const Surface* foundOn = nullptr;
  Closest found;
  double reach, others = infinite; // reach: what is farther is of no interest
  ClosestVisitor(const Vec3d& p, double radius) : point(p), reach(radius), radius_(radius) {}
  double visit(uint32_t triangle) override {
    if (surface->mesh->isInRange(triangle))
      if (const auto at = closestOnTriangle(point, surface->triangle(triangle), reach))
        add(triangle, *at);
    return reach * surface->frame.stretch() + slack;
  }
  void add(uint32_t primitive, const DoubleClosest& at) {
    if (!(at.distance <= radius_)) return;
    double other = at.distance - at.distanceError;
    const auto key = [](const DoubleClosest& c, uint32_t record, uint32_t number) {
      return std::tuple(c.distance, record, number);
    };
    if (!foundOn ||
        key(at, surface->record, primitive) < key(found.at, found.record, found.primitive)) {
      if (foundOn)
        other = found.at.distance - found.at.distanceError;
      else
        other = infinite;
      found.record = surface->record;
      found.primitive = primitive;
      found.at = at;
      foundOn = surface;
    }
    others = std::min(others, other);
    reach = std::min(radius_, found.at.distance + found.at.distanceError);
  }
  double slack = 0; // in the frame of the surface

 private:
  double radius_;
};

void DoubleScene::approach(const Surface& surface, ClosestVisitor& to) const {
  to.surface = &surface;
  if (!surface.mesh) {
    const ClosestOnSphere at = closestOnSphere(to.point, surface.world, surface.radius);
    return to.add(0, {at.distance, 0, 0, at.distanceError, 0});
  }
  const SearchFrame::Spot spot = surface.frame.spotOf(to.point);
  // Points so far away that boxes tell nothing, and frames that rounding spoils.
  if (!surface.mesh->boxes || !(spot.error <= 1) || !(largest(abs(spot.point)) <= 1e6)) {
    for (uint32_t t = 0; t < surface.mesh->count; t++) to.visit(t);
    return;
  }
  to.slack = 2 * spot.error;
  surface.mesh->boxes->visitNear(spot.point, to.reach * surface.frame.stretch() + to.slack, to);
}

bool DoubleScene::closest(const Vec3d& point, double radius, Closest& found) const {
  // The surface whose box is nearest comes first, so that most others need not be searched.
  const auto distanceTo = [&](const Surface& s) {
    const Vec3d outside = max(max(s.box.low - point, point - s.box.high), Vec3d{});
    const double error =
        0x1p-40 * (largest(abs(point)) + largest(max(abs(s.box.low), abs(s.box.high))));
    return length(outside) - 4 * error;
  };
  const Surface* first = nullptr;
  double least = infinite;
  for (const Surface& s : surfaces_->surfaces())
    if (const double d = distanceTo(s); !s.analytic && d < least) {
      least = d;
      first = &s;
    }
  if (!first || !(least <= radius)) return false;
  ClosestVisitor visitor(point, radius);
  approach(*first, visitor);
  for (const Surface& s : surfaces_->surfaces())
    if (&s != first && !s.analytic && distanceTo(s) <= visitor.reach) approach(s, visitor);
  if (!visitor.foundOn) return false;
  found = visitor.found;
  // The true distance is not below the least of all.
  found.at.distanceError =
      std::max(found.at.distanceError, (found.at.distance - visitor.others) * (1 + 0x1p-50));
  const Surface& on = *visitor.foundOn;
  found.place = on.mesh ? placeOnTriangle(on.triangle(found.primitive),
                                          {0, found.at.u, found.at.v, 0, found.at.uvError})
                        : closestOnSphere(point, on.world, on.radius).place;
  found.normal = normalAt(on, found.primitive, found.place.point);
  return true;
}

uint32_t DoubleScene::unevenSphere() const {
  for (const Surface& s : surfaces_->surfaces())
    if (!s.mesh && !s.analytic && shapeOf(s.world).uneven > 1e-9) return s.record;
  return noHit;
}

} // namespace openrt
