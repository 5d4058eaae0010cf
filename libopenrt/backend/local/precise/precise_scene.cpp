// precise_scene.cpp: builds and searches a PreciseScene.
#include "backend/local/precise/precise_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "backend/local/accel/bake.h"

namespace openrt {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Larger coordinates are dropped, as by Embree.
constexpr float farthest = 1e18f;

auto keyOf(const PreciseScene::Hit& h) { return std::tuple(h.at.t, h.record, h.primitive); }

} // namespace

// The triangles of a geometry, and their boxes in a frame: vertex minus `center`, times `unit`.
struct PreciseScene::Mesh {
  ArrayPtr points, indices;
  uint32_t count = 0;
  Vec3d center, half; // the bounds
  double unit = 1;
  bool empty = true;
  std::unique_ptr<CandidateScene> boxes; // null if the triangles are few

  Vec3f corner(uint32_t triangle, size_t k) const {
    return vectorOf(points->as<float>() + 3 * size_t(indices->as<uint32_t>()[3 * triangle + k]));
  }
  bool isInRange(uint32_t t) const {
    return largest(max(max(abs(corner(t, 0)), abs(corner(t, 1))), abs(corner(t, 2)))) <= farthest;
  }
  Mesh(const EmbreeDevice& device, const Geometry& g)
      : points(g.points), indices(g.indices), count(uint32_t(g.primitives())) {
    if (!consistent(g)) return;
    Box bounds;
    for (uint32_t t = 0; t < count; t++)
      for (size_t k = 0; k < 3 && isInRange(t); k++) bounds.add(Vec3d(corner(t, k)));
    empty = bounds.empty();
    if (empty) return;
    center = (bounds.low + bounds.high) * 0.5;
    half = (bounds.high - bounds.low) * 0.5;
    unit = unitOf(largest(half));
    if (count <= fewTriangles) return;
    boxes = std::make_unique<CandidateScene>(device, count, [&](uint32_t t) {
      if (!isInRange(t)) return Span{{1, 1, 1}, {1, 1, 1}}; // is never crossed
      const Vec3d a(corner(t, 0)), b(corner(t, 1)), c(corner(t, 2));
      return Span{(min(min(a, b), c) - center) * unit, (max(max(a, b), c) - center) * unit};
    });
  }
};

// A placed geometry.
struct PreciseScene::Surface {
  uint32_t record;
  std::shared_ptr<const Mesh> mesh;                // null for spheres and analytic surfaces
  std::shared_ptr<const AnalyticSurface> analytic; // null for the others
  double radius;                                   // the radius of a sphere
  bool clockwise;
  Matrix4d world, inverse; // from the frame of the vertices to the world, and back
  SearchFrame frame;       // the frame of the mesh's boxes
  Span box;                // in the world

  PlacedTriangle triangle(uint32_t t) const {
    return {mesh->corner(t, 0), mesh->corner(t, 1), mesh->corner(t, 2), world};
  }
};

// The least t that any other crossing may truly have is `others`.
class PreciseScene::Nearest final : public Collector {
 public:
  Hit hit;
  double others = infinite;
  double add(const Hit& h) override {
    // The first of several at the same place wins, in whatever order they come.
    Hit other = h;
    if (hit.record == noHit || keyOf(h) < keyOf(hit)) std::swap(hit, other);
    if (other.record != noHit) others = std::min(others, other.at.t - other.at.tError);
    return far = hit.at.t + hit.at.tError;
  }
};

class PreciseScene::MeshVisitor final : public CandidateVisitor {
 public:
  MeshVisitor(const PreciseScene& scene, const Surface& surface, const PreciseRay& ray,
              const SearchFrame::Way& way, Collector& to)
      : scene_(scene), surface_(surface), ray_(ray), way_(way), to_(to) {}
  double visit(uint32_t triangle) override {
    return way_.fromWorld(scene_.meetTriangle(surface_, triangle, ray_, to_));
  }

 private:
  const PreciseScene& scene_;
  const Surface& surface_;
  const PreciseRay& ray_;
  const SearchFrame::Way& way_;
  Collector& to_;
};

class PreciseScene::TopVisitor final : public CandidateVisitor {
 public:
  TopVisitor(const PreciseScene& scene, const PreciseRay& ray, const SearchFrame::Way& way,
             Collector& to)
      : scene_(scene), ray_(ray), way_(way), to_(to) {}
  double visit(uint32_t surface) override {
    return way_.fromWorld(scene_.meet(scene_.surfaces_[surface], ray_, to_));
  }

 private:
  const PreciseScene& scene_;
  const PreciseRay& ray_;
  const SearchFrame::Way& way_;
  Collector& to_;
};

PreciseScene::PreciseScene(const EmbreeDevice& device, const Input& input,
                           const PreciseScene* former)
    : surfaceOf_(input.accel.records.size(), ~0u) {
  for (uint32_t c = 0; c < input.flat.clusters.size(); c++)
    if (c == 0 || input.flat.clusters[c].visible) addSurfaces(device, input, c, former);
  makeTop(device);
}

PreciseScene::~PreciseScene() = default;

// Adds what a cluster shows, with the matrices that accel_records.cpp uses, but in the world.
void PreciseScene::addSurfaces(const EmbreeDevice& device, const Input& input, uint32_t number,
                               const PreciseScene* former) {
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

void PreciseScene::addSurface(const EmbreeDevice& device, const Geometry& g, const Matrix4d& world,
                              uint32_t record, const PreciseScene* former) {
  const bool triangles = g.primitive == edit::Primitive::Triangles,
             sphere = g.primitive == edit::Primitive::Sphere;
  if (!(triangles || sphere || g.surface) || !world.usable()) return;
  if (sphere && !consistent(g)) return;
  Surface s{record,         nullptr, g.surface, double(g.width), g.clockwise, world,
            inverse(world), {},      {}};
  Span bounds{Vec3d{-1, -1, -1} * s.radius, Vec3d{1, 1, 1} * s.radius};
  if (triangles) {
    s.mesh = meshOf(device, g, former);
    if (s.mesh->empty) return;
    bounds = {s.mesh->center - s.mesh->half, s.mesh->center + s.mesh->half};
    s.frame = SearchFrame(world, s.mesh->center, s.mesh->unit);
  } else if (s.analytic) {
    bounds = {s.analytic->low(), s.analytic->high()};
  }
  const Vec3d reach = (bounds.high - bounds.low) * 0.5,
              middle = world.point((bounds.low + bounds.high) * 0.5),
              half = abs(world.column(0)) * reach.x + abs(world.column(1)) * reach.y +
                     abs(world.column(2)) * reach.z;
  s.box = {middle - half, middle + half};
  surfaceOf_[record] = uint32_t(surfaces_.size());
  surfaces_.push_back(std::move(s));
}

// The arrays of a mesh live as long as the mesh, so equal addresses mean the same arrays.
std::shared_ptr<const PreciseScene::Mesh>
PreciseScene::meshOf(const EmbreeDevice& device, const Geometry& g, const PreciseScene* former) {
  const Key key{g.points.get(), g.indices.get()};
  std::shared_ptr<const Mesh>& mesh = meshes_[key];
  if (mesh) return mesh;
  if (former)
    if (const auto known = former->meshes_.find(key); known != former->meshes_.end())
      mesh = known->second;
  if (!mesh) mesh = std::make_shared<const Mesh>(device, g);
  return mesh;
}

void PreciseScene::makeTop(const EmbreeDevice& device) {
  if (surfaces_.size() <= fewSurfaces) return;
  Box bounds;
  for (const Surface& s : surfaces_) {
    bounds.add(s.box.low);
    bounds.add(s.box.high);
  }
  const Vec3d center = (bounds.low + bounds.high) * 0.5;
  const double unit = unitOf(largest(bounds.high - bounds.low) * 0.5);
  frame_ = SearchFrame(Matrix4d(), center, unit);
  top_ = std::make_unique<CandidateScene>(device, uint32_t(surfaces_.size()), [&](uint32_t i) {
    const Span& box = surfaces_[i].box;
    return Span{(box.low - center) * unit, (box.high - center) * unit};
  });
}

void PreciseScene::search(const PreciseRay& ray, Collector& to) const {
  if (top_) {
    const SearchFrame::Way way = frame_.wayOf(ray, ray.far);
    if (way.search == SearchFrame::Search::none) return;
    if (way.search == SearchFrame::Search::tree) {
      TopVisitor visitor(*this, ray, way, to);
      return top_->visit(way.ray, visitor);
    }
  }
  for (const Surface& surface : surfaces_)
    if (meet(surface, ray, to) < ray.near) return;
}

double PreciseScene::meet(const Surface& surface, const PreciseRay& ray, Collector& to) const {
  if (surface.analytic) return meetAnalytic(surface, ray, to);
  return surface.mesh ? meetMesh(surface, ray, to) : meetSphere(surface, ray, to);
}

double PreciseScene::meetMesh(const Surface& surface, const PreciseRay& ray, Collector& to) const {
  const SearchFrame::Way way = surface.frame.wayOf(ray, std::min(ray.far, to.far));
  if (way.search == SearchFrame::Search::none) return to.far;
  if (way.search == SearchFrame::Search::tree && surface.mesh->boxes) {
    MeshVisitor visitor(*this, surface, ray, way, to);
    surface.mesh->boxes->visit(way.ray, visitor);
  } else {
    for (uint32_t t = 0; t < surface.mesh->count && to.far >= ray.near; t++)
      meetTriangle(surface, t, ray, to);
  }
  return to.far;
}

double PreciseScene::meetTriangle(const Surface& surface, uint32_t triangle, const PreciseRay& ray,
                                  Collector& to) const {
  Hit hit{surface.record, triangle, {}};
  if (surface.mesh->isInRange(triangle) && crosses(ray, surface.triangle(triangle), hit.at))
    return to.add(hit);
  return to.far;
}

double PreciseScene::meetSphere(const Surface& surface, const PreciseRay& ray,
                                Collector& to) const {
  PreciseCrossing found[2];
  const int count = crossSphere(ray, surface.world, surface.radius, found);
  for (int i = 0; i < count; i++) to.add({surface.record, 0, found[i]});
  return to.far;
}

double PreciseScene::meetAnalytic(const Surface& surface, const PreciseRay& ray,
                                  Collector& to) const {
  const Vec3d from = ray.origin - surface.world.translation();
  const AnalyticSurface::Crossings found = surface.analytic->intersect(
      surface.inverse.direction(from), surface.inverse.direction(ray.direction));
  for (size_t i = 0; i < size_t(found.count); i++) {
    const double t = found.t[i];
    if (t > ray.near && t <= ray.far)
      to.add({surface.record,
              0,
              {t, 0, 0, analyticError(ray, surface.world, *surface.analytic, t), 0}});
  }
  return to.far;
}

bool PreciseScene::nearest(const PreciseRay& ray, Hit& hit) const {
  Nearest found;
  search(ray, found);
  hit = found.hit;
  if (hit.record == noHit) return false;
  // The true first crossing is not before the least of all.
  hit.ambiguous = found.others <= hit.at.t + hit.at.tError;
  hit.at.tError = std::max(hit.at.tError, (hit.at.t - found.others) * (1 + 0x1p-50));
  return true;
}

bool PreciseScene::occluded(const PreciseRay& ray) const {
  AnyCrossing<Hit> found;
  search(ray, found);
  return found.met;
}

void PreciseScene::all(const PreciseRay& ray, std::vector<Hit>& hits) const {
  hits.clear();
  AllCrossings<Hit> found(hits);
  search(ray, found);
  std::sort(hits.begin(), hits.end(),
            [](const Hit& a, const Hit& b) { return keyOf(a) < keyOf(b); });
}

size_t PreciseScene::count(const PreciseRay& ray) const {
  CrossingCounter<Hit> found;
  search(ray, found);
  return found.count;
}

PrecisePlace PreciseScene::place(const Hit& hit, const PreciseRay& ray) const {
  const Surface& surface = surfaces_[surfaceOf_[hit.record]];
  const PrecisePlace onRay = placeOnRay(ray, hit.at);
  if (!surface.mesh || hit.ambiguous) return onRay;
  const PrecisePlace onTriangle = placeOnTriangle(surface.triangle(hit.primitive), hit.at);
  return onTriangle.error < onRay.error ? onTriangle : onRay;
}

Vec3d PreciseScene::normal(const Hit& hit, const PreciseRay& ray) const {
  return normalAt(surfaces_[surfaceOf_[hit.record]], hit.primitive, ray.at(hit.at.t));
}

// Mirrored triangles keep their front side: their corners run clockwise in the world.
Vec3d PreciseScene::normalAt(const Surface& surface, uint32_t primitive, const Vec3d& place) const {
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
class PreciseScene::ClosestVisitor final : public CandidateVisitor {
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
  void add(uint32_t primitive, const PreciseClosest& at) {
    if (!(at.distance <= radius_)) return;
    double other = at.distance - at.distanceError;
    const auto key = [](const PreciseClosest& c, uint32_t record, uint32_t number) {
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

void PreciseScene::approach(const Surface& surface, ClosestVisitor& to) const {
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

bool PreciseScene::closest(const Vec3d& point, double radius, Closest& found) const {
  // The surface whose box is nearest comes first, so that most others need not be searched.
  const auto distanceTo = [&](const Surface& s) {
    const Vec3d outside = max(max(s.box.low - point, point - s.box.high), Vec3d{});
    const double error =
        0x1p-40 * (largest(abs(point)) + largest(max(abs(s.box.low), abs(s.box.high))));
    return length(outside) - 4 * error;
  };
  const Surface* first = nullptr;
  double least = infinite;
  for (const Surface& s : surfaces_)
    if (const double d = distanceTo(s); !s.analytic && d < least) {
      least = d;
      first = &s;
    }
  if (!first || !(least <= radius)) return false;
  ClosestVisitor visitor(point, radius);
  approach(*first, visitor);
  for (const Surface& s : surfaces_)
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

uint32_t PreciseScene::unevenSphere() const {
  for (const Surface& s : surfaces_)
    if (!s.mesh && !s.analytic && shapeOf(s.world).uneven > 1e-9) return s.record;
  return noHit;
}

} // namespace openrt
