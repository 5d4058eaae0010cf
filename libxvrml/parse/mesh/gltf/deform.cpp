// deform.cpp: moves the vertices of a primitive by morph targets (glTF 2.0, 3.7.2.2).
#include "parse/mesh/gltf/primitives.h"

namespace xvrml::gltf {
namespace {

void addScaled(std::vector<Vec3f>& to, const std::vector<Vec3f>& move, double weight) {
  const float w = float(weight);
  for (size_t i = 0; i < to.size() && i < move.size(); ++i)
    to[i] = {to[i].x + w * move[i].x, to[i].y + w * move[i].y, to[i].z + w * move[i].z};
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

} // namespace xvrml::gltf
