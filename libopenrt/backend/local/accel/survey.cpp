// survey.cpp: measures objects and parts of a scene, and chooses the origin and the scale of render
// space. Called on the application thread, between frames.
#include "backend/local/accel/survey.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

// Up to this number of copied triangles, baked copies of an object are cheaper than instances.
constexpr uint64_t bakedTriangles = 50000;

// Returns log2 of a length, clamped to the range that the kernels accept.
int exponent(double length) { return std::ilogb(std::clamp(length, 1e-30, 1e30)); }

double largestColumn(const Matrix4d& m) {
  return std::max({length(m.column(0)), length(m.column(1)), length(m.column(2))});
}

// Returns a lower bound of the factor by which a matrix stretches: the determinant is the product
// of the singular values, and the product of two is at most half the sum of all their squares.
double leastStretch(const Matrix4d& m) {
  const double squares =
      dot(m.column(0), m.column(0)) + dot(m.column(1), m.column(1)) + dot(m.column(2), m.column(2));
  return squares > 0 ? 2 * std::fabs(m.determinant()) / squares : 0;
}

} // namespace

Matrix4d matrixOf(const Affine& affine) {
  Matrix4d m;
  for (size_t i = 0; i < 3; i++)
    for (size_t j = 0; j < 4; j++) m.m[4 * j + i] = double(affine.r[i][j]);
  return m;
}

Matrix4d uniformScale(double s) {
  Matrix4d m;
  m.m[0] = m.m[5] = m.m[10] = s;
  return m;
}

bool similarity(const Matrix4d& m) {
  const Vec3d a = m.column(0), b = m.column(1), c = m.column(2);
  const double l = dot(a, a), e = 1e-6 * l;
  return std::fabs(dot(b, b) - l) <= e && std::fabs(dot(c, c) - l) <= e &&
         std::fabs(dot(a, b)) <= e && std::fabs(dot(a, c)) <= e && std::fabs(dot(b, c)) <= e;
}

void Survey::measure(const Scene& scene, uint32_t id) {
  const Object& object = scene.objects.at(id);
  ObjectInfo& known = objects_[id];
  if (known.version == object.version) return;
  ObjectInfo info;
  info.version = object.version;
  for (const Geometry& g : object.geometries) {
    const Box box = boundsOf(g);
    info.sizes.push_back(halfDiagonal(box));
    info.bounds.add(box, Matrix4d());
    if (g.primitive == edit::Primitive::Triangles) info.triangles += g.primitives();
    if (isThin(g.primitive)) info.bakeOnly = true;
    if (g.primitive == edit::Primitive::Sphere && !similarity(g.matrix)) info.bakeOnly = true;
  }
  for (const double size : info.sizes)
    info.bakeOnly |= size > 0 && halfDiagonal(info.bounds) > largestToSmallest * size;
  known = std::move(info);
}

bool Survey::isShared(uint32_t id) const {
  const ObjectInfo& info = objects_.at(id);
  const uint64_t uses = uses_.at(id);
  return !info.bakeOnly && uses > 1 && info.triangles * (uses - 1) > bakedTriangles;
}

PartInfo Survey::measurePart(const Scene& scene, const ScenePart& part, bool root) const {
  PartInfo info;
  for (uint32_t i = 0; i < part.items.size(); i++) {
    const Item& item = part.items[i];
    const ObjectInfo& object = objects_.at(item.object);
    info.firstEntry.push_back(info.entries());
    info.bounds.add(object.bounds, item.matrix);
    info.triangles += object.triangles;
    const bool shared = isShared(item.object);
    if (shared) info.sharedItems.push_back(i);
    const auto& geometries = scene.objects.at(item.object).geometries;
    for (uint32_t g = 0; g < geometries.size(); g++) {
      DrawnAs drawn = DrawnAs::baked;
      switch (geometries[g].primitive) {
      case edit::Primitive::Lines:
        info.lines = true;
        drawn = DrawnAs::thin;
        break;
      case edit::Primitive::Points:
        info.points = true;
        drawn = DrawnAs::thin;
        break;
      case edit::Primitive::Sphere:
        if (!shared && !root && !similarity(item.matrix * geometries[g].matrix))
          drawn = DrawnAs::ellipsoid;
        break;
      case edit::Primitive::Triangles:
      case edit::Primitive::Quadric:
      case edit::Primitive::Asphere: break;
      }
      if (shared) drawn = DrawnAs::shared;
      if (drawn == DrawnAs::ellipsoid) info.ellipsoids.emplace_back(i, g);
      if (drawn == DrawnAs::baked) info.baked = 1;
      info.framed += hasFrames(geometries[g], drawn, root);
      info.drawn.push_back(drawn);
    }
  }
  if (!root && info.baked) groupBaked(scene, part, info);
  return info;
}

// Splits the baked geometry of a part in which something may be too small for the part's frame.
void Survey::groupBaked(const Scene& scene, const ScenePart& part, PartInfo& info) const {
  const double size = halfDiagonal(info.bounds);
  bool fits = true;
  for (uint32_t i = 0; i < part.items.size() && fits; i++) {
    const double stretch = leastStretch(part.items[i].matrix) * largestToSmallest;
    for (const double its : objects_.at(part.items[i].object).sizes)
      fits &= !(its > 0) || its * stretch >= size;
  }
  if (fits) return;
  std::vector<Box> boxes(info.entries());
  for (uint32_t i = 0; i < part.items.size(); i++) {
    const auto& geometries = scene.objects.at(part.items[i].object).geometries;
    for (uint32_t g = 0; g < geometries.size(); g++)
      if (const uint32_t entry = info.firstEntry[i] + g; info.drawn[entry] == DrawnAs::baked)
        boxes[entry].add(boundsOf(geometries[g]), part.items[i].matrix);
  }
  info.groups = groupBySize(boxes);
  info.baked = *std::max_element(info.groups.begin(), info.groups.end()) + 1;
}

void Survey::take(const Scene& scene, const Flattened& flat) {
  uses_.clear();
  partOf_.clear();
  parts_.clear();
  for (const ScenePart& part : flat.parts)
    for (const Item& item : part.items)
      if (uses_[item.object]++ == 0) measure(scene, item.object);
  std::erase_if(objects_, [&](const auto& entry) { return !uses_.contains(entry.first); });
  for (uint32_t p = 0; p < flat.parts.size(); p++) {
    partOf_[flat.parts[p].object] = p;
    parts_.push_back(measurePart(scene, flat.parts[p], p == 0));
  }
  boxes_.assign(flat.clusters.size(), {});
  for (uint32_t c = 0; c < flat.clusters.size(); c++)
    parts_[flat.clusters[c].part].clusters.push_back(c);
  std::vector<uint32_t> all(flat.clusters.size());
  for (uint32_t c = 0; c < all.size(); c++) all[c] = c;
  place(flat, all);

  measureDetail(scene, flat);
}

// The detail is that of what is static. Where nothing is, it is that of the parts, without the
// matrices of their instances.
void Survey::measureDetail(const Scene& scene, const Flattened& flat) {
  std::map<int, uint64_t> sizes; // number of primitives for each size (log2)
  uint64_t total = 0;
  const auto add = [&](const ScenePart& part) {
    for (const Item& item : part.items) {
      const auto& geometries = scene.objects.at(item.object).geometries;
      const auto& itsSizes = objects_.at(item.object).sizes;
      const double growth = largestColumn(item.matrix);
      for (size_t g = 0; g < geometries.size(); g++) {
        sizes[exponent(itsSizes[g] * growth)] += geometries[g].primitives();
        total += geometries[g].primitives();
      }
    }
  };
  add(flat.parts[0]);
  if (total == 0)
    for (const ScenePart& part : flat.parts) add(part);
  detail_ = 200;
  uint64_t below = 0;
  for (const auto& [size, count] : sizes) {
    below += count;
    if (2 * below < total) continue;
    detail_ = size;
    break;
  }
}

bool Survey::resurveyObject(const Scene& scene, const Flattened& flat, uint32_t object) {
  const uint32_t p = partOf(object);
  if (p == ~0u || flat.parts[p].items.empty() || flat.parts[p].items[0].object != object)
    return false;
  if (scene.objects.at(object).geometries.empty()) return false;
  measure(scene, object);
  PartInfo fresh = measurePart(scene, flat.parts[p], false);
  fresh.clusters = std::move(parts_[p].clusters);
  const bool same = fresh.drawn == parts_[p].drawn && fresh.groups == parts_[p].groups &&
                    fresh.lines == parts_[p].lines && fresh.points == parts_[p].points;
  parts_[p] = std::move(fresh);
  place(flat, parts_[p].clusters);
  return same;
}

bool Survey::resurvey(const Scene& scene, const Flattened& flat,
                      const std::vector<uint32_t>& objects) {
  for (const uint32_t object : objects)
    if (!resurveyObject(scene, flat, object)) return false;
  if (!objects.empty() && flat.parts[0].items.empty()) measureDetail(scene, flat);
  return true;
}

void Survey::place(const Flattened& flat, const std::vector<uint32_t>& clusters) {
  for (uint32_t c : clusters) {
    const Cluster& cluster = flat.clusters[c];
    boxes_[c] = {};
    if (cluster.world.usable()) boxes_[c].add(parts_[cluster.part].bounds, cluster.world);
  }
}

uint32_t Survey::partOf(uint32_t object) const {
  const auto found = partOf_.find(object);
  return found == partOf_.end() ? ~0u : found->second;
}

uint64_t Survey::uniqueTriangles() const {
  uint64_t sum = 0;
  for (const auto& [id, info] : objects_) sum += info.triangles;
  return sum;
}

Box Survey::bounds() const {
  Box all;
  for (const Box& box : boxes_)
    if (!box.empty()) {
      all.add(box.low);
      all.add(box.high);
    }
  return all;
}

Vec3d Survey::origin(const Vec3d& eye) const {
  const Box box = boxes_.empty() ? Box() : boxes_[0].empty() ? bounds() : boxes_[0];
  const double radius = halfDiagonal(box);
  if (!(radius > 0) || !std::isfinite(radius)) return {};
  const double cell = std::ldexp(1.0, std::min(exponent(radius) + 2, detail_ + 16));
  const auto snap = [cell](double x) {
    // The offset keeps the grid lines away from round numbers, where cameras often stand and turn.
    const double at = std::floor(x / cell + 0.43) * cell;
    return std::isfinite(at) ? at : 0.0;
  };
  return {snap(eye.x), snap(eye.y), snap(eye.z)};
}

double Survey::farthest(const Vec3d& origin) const {
  const Box world = bounds();
  return world.empty() ? 0 : largest(max(abs(world.low - origin), abs(world.high - origin)));
}

double Survey::reach(const Vec3d& origin) const {
  const double far = farthest(origin);
  return far > 0 ? std::exp2(10 * std::ceil(std::log2(far) / 10)) : 0;
}

double Survey::scale(const Vec3d& origin) const {
  const double far = farthest(origin);
  if (!(far > 0)) return 1;
  const auto powerOfTwo = [](double x) { return std::exp2(std::floor(std::log2(x))); };
  if (far < 1e-4) return powerOfTwo(1 / far); // small scenes are scaled up to about 1
  // Large scenes are scaled down to the upper end of the range in which the kernels work well
  // (1e-10 to 1e12). The median size of the geometry stays above 1e-3, so that one object placed
  // far away does not change everything else. The kernels' limit is a distance of 1e17. Geometry
  // beyond 1e20 is not drawn.
  const double reach = std::min(far, 1e20), comfortable = 1e10 / reach;
  if (comfortable >= 1) return 1;
  return powerOfTwo(
      std::max(comfortable, std::min({1.0, std::ldexp(1e-3, -detail_), 1e17 / reach})));
}

} // namespace openrt
