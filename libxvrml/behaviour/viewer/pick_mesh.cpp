// pick_mesh.cpp: intersects rays with triangles and spheres, in double precision.
#include "behaviour/viewer/pick_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace xvrml {

void PickBox::extend(const Vector& p) {
  for (int i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], p[i]);
    high[i] = std::max(high[i], p[i]);
  }
}

void PickBox::extend(const PickBox& b) {
  if (b.empty()) return;
  extend(b.low);
  extend(b.high);
}

void PickBox::extend(const PickBox& b, const Matrix& m) {
  if (b.empty()) return;
  for (int corner = 0; corner < 8; ++corner)
    extend(transformPoint(m, {corner & 1 ? b.high.x : b.low.x, corner & 2 ? b.high.y : b.low.y,
                              corner & 4 ? b.high.z : b.low.z}));
}

// The rest of a box has its corners at those of the box and where its edges meet the plane.
void PickBox::cut(const HalfSpace& halfSpace) {
  if (empty()) return;
  PickBox left;
  const auto corner = [&](int i) {
    return Vector(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  };
  for (int i = 0; i < 8; ++i) {
    const double here = halfSpace.distance(corner(i));
    if (here >= 0) left.extend(corner(i));
    for (int bit = 1; bit < 8; bit *= 2) {
      const double there = halfSpace.distance(corner(i | bit));
      if ((i & bit) == 0 && ((here > 0 && there < 0) || (here < 0 && there > 0)))
        left.extend(corner(i) + (corner(i | bit) - corner(i)) * (here / (here - there)));
    }
  }
  *this = left;
}

void PickBox::pad() {
  if (empty()) return;
  const double size = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x),
                                std::abs(high.y), std::abs(high.z)});
  const double margin = 1e-9 * size + 1e-30;
  low -= Vector(margin);
  high += Vector(margin);
}

bool PickRay::intersects(const PickBox& box) const {
  if (box.empty()) return false;
  double enter = nearest, leave = farthest;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (!(origin[i] >= box.low[i] && origin[i] <= box.high[i])) return false;
      continue;
    }
    double a = (box.low[i] - origin[i]) / direction[i],
           b = (box.high[i] - origin[i]) / direction[i];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
    if (!(enter <= leave)) return false;
  }
  return true;
}

PickMesh::PickMesh(Node& geometry, const Limits* limits)
    : mesh_(
          buildMesh(geometry, {.needTexCoords = true, .limits = limits, .diagnostics = nullptr})) {
  if (mesh_.kind == Mesh::Kind::sphere) {
    bounds_.extend(Vector(mesh_.radius));
    bounds_.extend(Vector(-double(mesh_.radius)));
  } else if (mesh_.kind !=
             Mesh::Kind::empty) { // no ray hits lines and points, but viewAll shows them
    for (const uint32_t i : mesh_.indices) {
      if (i >= mesh_.points.size()) { // impossible: builders check
        mesh_.kind = Mesh::Kind::empty;
        return;
      }
      const Vector p = vector(mesh_.points[i]);
      if (std::isfinite(p.x + p.y + p.z)) bounds_.extend(p);
    }
    if (mesh_.kind == Mesh::Kind::triangles && mesh_.indices.size() / 3 > 64) {
      order_.resize(mesh_.indices.size() / 3);
      std::iota(order_.begin(), order_.end(), 0u);
      bvh_.push_back({.first = 0, .count = uint32_t(order_.size())});
    }
  }
  bounds_.pad();
}

Vector PickMesh::corner(uint32_t triangle, int k) const {
  return vector(mesh_.points[mesh_.indices[size_t(triangle) * 3 + size_t(k)]]);
}

// Finds the box of a node, and whether it is worth splitting.
void PickMesh::measure(BvhNode& bvhNode) const {
  PickBox middles;
  for (uint32_t i = bvhNode.first; i < bvhNode.first + bvhNode.count; ++i) {
    const Vector a = corner(order_[i], 0), b = corner(order_[i], 1), c = corner(order_[i], 2);
    for (const Vector& p : {a, b, c}) bvhNode.box.extend(p);
    middles.extend(a + b + c);
  }
  bvhNode.box.pad();
  const bool splits = bvhNode.count > 8 && !middles.empty();
  const Vector size = splits ? middles.high - middles.low : Vector(0);
  bvhNode.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  bvhNode.state = splits ? BvhNode::State::splits : BvhNode::State::remains;
}

// Splits a node into equal halves along the longest side, so the depth is the logarithm of the
// number of triangles.
void PickMesh::split(uint32_t number) {
  const BvhNode whole = bvh_[number];
  std::vector<std::pair<double, uint32_t>> sorted(whole.count); // triangles with their middles
  for (uint32_t i = 0; i < whole.count; ++i) {
    const uint32_t t = order_[whole.first + i];
    const double v = corner(t, 0)[whole.axis] + corner(t, 1)[whole.axis] + corner(t, 2)[whole.axis];
    sorted[i] = {std::isfinite(v) ? v : 0, t};
  }
  const uint32_t half = whole.count / 2;
  std::nth_element(sorted.begin(), sorted.begin() + half, sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (uint32_t i = 0; i < whole.count; ++i) order_[whole.first + i] = sorted[i].second;
  const auto next = uint32_t(bvh_.size());
  bvh_.push_back({.first = whole.first, .count = half});
  bvh_.push_back({.first = whole.first + half, .count = whole.count - half});
  bvh_[number].next = next;
  bvh_[number].count = 0;
  bvh_[number].state = BvhNode::State::hasHalves;
}

void PickMesh::prepare() {
  constexpr uint32_t few = 16'384; // triangles that a ray may have to sort
  mesh_.takeAll();
  for (uint32_t number = 0; number < bvh_.size(); ++number) { // split() appends the halves
    if (bvh_[number].count <= few) continue;
    if (bvh_[number].state == BvhNode::State::fresh) measure(bvh_[number]);
    if (bvh_[number].state == BvhNode::State::splits) split(number);
  }
}

// Textures wrap counterclockwise, seen from above, from the back of the sphere (clause 6.43).
bool PickMesh::sphere(const PickRay& ray, bool bothSides, MeshHit& hit) const {
  const double radius = mesh_.radius, a = ray.direction.dot(ray.direction);
  if (!(a > 0)) return false;
  const double nearest = -ray.origin.dot(ray.direction) / a;
  const Vector foot = ray.at(nearest); // avoids the cancellation of the usual formula
  const double rest = radius * radius - foot.dot(foot);
  if (!(rest >= 0)) return false;
  const double half = std::sqrt(rest / a);
  double t = nearest - half;
  if (!(t >= ray.nearest && t <= ray.farthest)) {
    t = nearest + half;
    if (!bothSides || !(t >= ray.nearest && t <= ray.farthest)) return false;
  }
  hit.t = t;
  hit.normal = ray.at(t) / radius;
  const double turn = std::atan2(-hit.normal.x, -hit.normal.z) / (2 * std::numbers::pi);
  hit.texCoord = {float(turn < 0 ? turn + 1 : turn),
                  float(0.5 + std::asin(std::clamp(hit.normal.y, -1.0, 1.0)) / std::numbers::pi)};
  return true;
}

// T. Moeller, B. Trumbore: Fast, minimum storage ray/triangle intersection (1997).
bool PickMesh::triangle(uint32_t index, PickRay& ray, bool bothSides, MeshHit& hit) const {
  const Vector a = corner(index, 0), ab = corner(index, 1) - a, ac = corner(index, 2) - a;
  const Vector p = ray.direction.cross(ac);
  const double d = ab.dot(p);
  if (d == 0 || !std::isfinite(d)) return false;
  const bool front = (d > 0) == mesh_.ccw;
  if (!front && mesh_.solid && !bothSides) return false;
  const Vector s = ray.origin - a;
  const double u = s.dot(p) / d;
  if (!(u >= 0 && u <= 1)) return false;
  const Vector q = s.cross(ab);
  const double v = ray.direction.dot(q) / d;
  if (!(v >= 0 && u + v <= 1)) return false;
  const double t = ac.dot(q) / d;
  if (!(t >= ray.nearest && t <= ray.farthest)) return false;
  ray.farthest = hit.t = t;
  const uint32_t i[3] = {mesh_.indices[size_t(index) * 3], mesh_.indices[size_t(index) * 3 + 1],
                         mesh_.indices[size_t(index) * 3 + 2]};
  const double w = 1 - u - v;
  Vector normal(0);
  if (!mesh_.normals.empty())
    normal = vector(mesh_.normals[i[0]]) * w + vector(mesh_.normals[i[1]]) * u +
             vector(mesh_.normals[i[2]]) * v;
  if (!(normal.length() > 0) || !std::isfinite(normal.length()))
    normal = ab.cross(ac) * (mesh_.ccw ? 1 : -1);
  hit.normal = normal.normalized();
  hit.texCoord = {};
  if (!mesh_.texCoords.empty()) {
    const Vec2f &ta = mesh_.texCoords[i[0]], &tb = mesh_.texCoords[i[1]],
                &tc = mesh_.texCoords[i[2]];
    hit.texCoord = {float(ta.x * w + tb.x * u + tc.x * v), float(ta.y * w + tb.y * u + tc.y * v)};
  }
  return true;
}

bool PickMesh::intersect(const PickRay& whole, bool bothSides, MeshHit& hit) {
  if (mesh_.kind == Mesh::Kind::sphere) return sphere(whole, bothSides, hit);
  if (mesh_.kind != Mesh::Kind::triangles) return false;
  PickRay ray = whole;
  bool found = false;
  if (bvh_.empty()) {
    for (uint32_t i = 0; i < mesh_.indices.size() / 3; ++i)
      found |= triangle(i, ray, bothSides, hit);
    return found;
  }
  using State = BvhNode::State;
  std::vector<uint32_t> open{0};
  while (!open.empty()) {
    const uint32_t number = open.back();
    open.pop_back();
    if (bvh_[number].state == State::fresh) measure(bvh_[number]);
    if (!ray.intersects(bvh_[number].box)) continue;
    if (bvh_[number].state == State::splits) split(number);
    const BvhNode& bvhNode = bvh_[number];
    if (bvhNode.state == State::hasHalves) {
      open.push_back(bvhNode.next + 1);
      open.push_back(bvhNode.next);
    }
    for (uint32_t i = 0; i < bvhNode.count; ++i)
      found |= triangle(order_[bvhNode.first + i], ray, bothSides, hit);
  }
  return found;
}

} // namespace xvrml
