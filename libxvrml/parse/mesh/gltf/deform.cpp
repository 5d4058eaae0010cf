// deform.cpp: moves the vertices of a primitive by morph targets (glTF 2.0, 3.7.2.2) and by a skin
// (3.7.3).
#include <cmath>

#include <fmt/format.h>

#include "parse/mesh/gltf/primitives.h"

namespace xvrml::gltf {
namespace {

using Imath::M44d;
using Imath::V3d;

void addScaled(std::vector<Vec3f>& to, const std::vector<Vec3f>& move, double weight) {
  const float w = float(weight);
  for (size_t i = 0; i < to.size() && i < move.size(); ++i)
    to[i] = {to[i].x + w * move[i].x, to[i].y + w * move[i].y, to[i].z + w * move[i].z};
}

V3d row(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

// Normals are transformed by the matrix of cofactors, which is the inverse transpose but for a
// factor.
V3d transformNormal(const M44d& m, const V3d& n) {
  const V3d a = row(m, 0), b = row(m, 1), c = row(m, 2);
  const V3d turned = b.cross(c) * n.x + c.cross(a) * n.y + a.cross(b) * n.z;
  return a.dot(b.cross(c)) < 0 ? -turned : turned;
}

Vec3f unitOf(const V3d& v, const Vec3f& fallback) {
  const double length = v.length();
  if (!(length > 0) || !std::isfinite(length)) return fallback;
  return {float(v.x / length), float(v.y / length), float(v.z / length)};
}

} // namespace

void Primitives::morph(const Item& primitive, const std::vector<double>& weights,
                       Vertices& vertices) {
  const std::vector<Item> targets = primitive.list("targets");
  if (targets.empty() || (weights.empty() && !keepMorphs_)) return;
  const size_t count = vertices.points.size();
  Morph kept;
  if (keepMorphs_) kept.base = vertices.points;
  for (size_t i = 0; i < targets.size(); ++i) {
    const double weight = i < weights.size() ? weights[i] : 0;
    if (!targets[i] || (weight == 0 && !keepMorphs_)) continue;
    MFVec3f move = readVectors(targets[i], "POSITION", count);
    addScaled(vertices.points, move, weight);
    if (weight != 0 && !vertices.normals.empty())
      addScaled(vertices.normals, readVectors(targets[i], "NORMAL", count), weight);
    if (keepMorphs_) kept.targets.push_back(std::move(move));
  }
  if (keepMorphs_) morphs_.push_back(std::move(kept));
}

void Primitives::skin(const Item& attributes, std::span<const M44d> joints, Vertices& vertices) {
  const size_t count = vertices.points.size();
  scratch_.take(count * (sizeof(M44d) + sizeof(double)));
  std::vector<M44d> blended(count, M44d(0.0));
  std::vector<double> sums(count, 0.0);
  uint64_t bad = 0;
  for (int set = 0; set < 8; ++set) {
    const auto jointAccessor = attributes.index(fmt::format("JOINTS_{}", set), accessors_.size());
    const auto weightAccessor = attributes.index(fmt::format("WEIGHTS_{}", set), accessors_.size());
    if (!jointAccessor || !weightAccessor) break;
    const Values joint = accessors_.read(*jointAccessor), weight = accessors_.read(*weightAccessor);
    if (joint.components != 4 || weight.components != 4 || joint.size() != count ||
        weight.size() != count) {
      attributes.error(fmt::format("JOINTS_{0} and WEIGHTS_{0} should have VEC4 for each vertex; "
                                   "they are left out",
                                   set));
      break;
    }
    for (size_t i = 0; i < 4 * count; ++i) {
      const double w = weight.numbers[i];
      if (!(w > 0)) continue;
      if (joint.numbers[i] >= float(joints.size())) {
        ++bad;
        continue;
      }
      blended[i / 4] += joints[size_t(joint.numbers[i])] * w;
      sums[i / 4] += w;
    }
  }
  if (bad > 0) attributes.error(fmt::format("{} joints are not in the skin", bad));
  for (size_t i = 0; i < count; ++i) {
    if (!(sums[i] > 0)) continue;
    const M44d m = blended[i] * (1 / sums[i]);
    const Vec3f& p = vertices.points[i];
    const V3d moved = V3d(p.x, p.y, p.z) * m;
    vertices.points[i] = {float(moved.x), float(moved.y), float(moved.z)};
    if (vertices.normals.empty()) continue;
    const Vec3f& n = vertices.normals[i];
    vertices.normals[i] = unitOf(transformNormal(m, {n.x, n.y, n.z}), n);
  }
}

} // namespace xvrml::gltf
