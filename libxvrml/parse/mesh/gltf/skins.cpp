// skins.cpp: gathers the vertices and weights of a figure, then writes its nodes.
#include "parse/mesh/gltf/skins.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace xvrml::gltf {

using Imath::M44d;

Skins::Skins(const MeshFile& file, const Item& root, Accessors& accessors, size_t nodes)
    : file_(file), accessors_(accessors), scratch_(file.budget), skins_(root.list("skins")) {
  for (const Item& skin : skins_) nodes_.push_back(skin.indices("joints", nodes));
}

void Skins::beginFigure() {
  parts_.clear();
  joints_.clear();
  points_.clear();
  normals_.clear();
  written_.clear();
  size_ = 0;
  smooth_ = false;
}

Skins::Part* Skins::find(const PartKey& key) {
  const auto found = parts_.find(key);
  return found == parts_.end() ? nullptr : &found->second;
}

void Skins::add(const PartKey& key, size_t skin, const Item& attributes, Vertices&& vertices) {
  const size_t count = vertices.points.size();
  if (size_ + count > INT32_MAX / 8) return attributes.error("too many vertices with a skin");
  scratch_.take(count * (2 * sizeof(Vec3f) + sizeof(Color) + sizeof(float)));
  addWeights(attributes, skin, count);
  const bool smooth = !vertices.normals.empty();
  parts_[key] = {size_, count, smooth, std::move(vertices.colors), std::move(vertices.alphas)};
  smooth_ = smooth_ || smooth;
  points_.insert(points_.end(), vertices.points.begin(), vertices.points.end());
  normals_.insert(normals_.end(), vertices.normals.begin(), vertices.normals.end());
  size_ += count;
  normals_.resize(size_); // parts without normals do not use theirs
}

std::vector<Skins::Set> Skins::readSets(const Item& attributes, size_t count) {
  std::vector<Set> sets;
  for (int number = 0; number < 8; ++number) {
    const auto joints = attributes.index(fmt::format("JOINTS_{}", number), accessors_.size());
    const auto weights = attributes.index(fmt::format("WEIGHTS_{}", number), accessors_.size());
    if (!joints || !weights) break;
    Set set{accessors_.read(*joints), accessors_.read(*weights)};
    const auto fits = [&](const Values& values) {
      return values.components == 4 && values.size() == count;
    };
    if (!fits(set.joints) || !fits(set.weights)) {
      attributes.error(fmt::format("JOINTS_{0} and WEIGHTS_{0} should have VEC4 for each vertex; "
                                   "they are left out",
                                   number));
      break;
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

// Returns one matrix for each joint; the identity where the file has none.
const std::vector<M44d>& Skins::bindsOf(size_t skin) {
  const auto [known, fresh] = binds_.try_emplace(skin);
  std::vector<M44d>& binds = known->second;
  if (!fresh) return binds;
  scratch_.take(nodes_[skin].size() * sizeof(M44d));
  binds.resize(nodes_[skin].size());
  const auto accessor = skins_[skin].index("inverseBindMatrices", accessors_.size());
  if (!accessor) return binds;
  const Values values = accessors_.read(*accessor);
  for (size_t i = 0; i < binds.size() && values.components == 16 && i < values.size(); ++i)
    for (size_t k = 0; k < 16; ++k)
      binds[i][int(k / 4)][int(k % 4)] = double(values.numbers[16 * i + k]);
  return binds;
}

// Gives the joints of a skin their vertices. The weights of a vertex are made to add up to 1.
void Skins::addWeights(const Item& attributes, size_t skin, size_t count) {
  const std::vector<Set> sets = readSets(attributes, count);
  const std::vector<M44d>& binds = bindsOf(skin);
  scratch_.take(count * sets.size() * 4 * (sizeof(int32_t) + sizeof(float)) +
                binds.size() * (sizeof(Joint) + sizeof(Joint*)));
  std::vector<Joint*> joints;
  for (size_t i = 0; i < binds.size(); ++i) {
    joints.push_back(&joints_[{nodes_[skin][i], skin}]);
    joints.back()->inverseBind = binds[i];
  }
  uint64_t bad = 0;
  for (size_t v = 0; v < count; ++v) {
    double sum = 0;
    const auto each = [&](const auto& visit) {
      for (const Set& set : sets)
        for (size_t i = 4 * v; i < 4 * v + 4; ++i)
          if (const float weight = set.weights.numbers[i]; weight > 0 && std::isfinite(weight))
            visit(set.joints.numbers[i], weight);
    };
    each([&](float joint, float weight) {
      const bool known = joint >= 0 && joint < float(joints.size());
      bad += !known;
      if (known) sum += double(weight);
    });
    each([&](float number, float weight) {
      if (!(number >= 0 && number < float(joints.size()))) return;
      Joint& joint = *joints[size_t(number)];
      joint.vertices.push_back(int32_t(size_ + v));
      joint.weights.push_back(float(double(weight) / sum));
    });
  }
  if (bad > 0) attributes.error(fmt::format("{} joints are not in the skin", bad));
}

void Skins::writeVertices(NodeStream& out) {
  out.openIn("skinCoord", "Coordinate", coordinate_ = out.define("Skin", "Skin"));
  out.set("point", std::move(points_));
  out.closeIn();
  if (!smooth_) return;
  out.openIn("skinNormal", "Normal", normal_ = out.define("SkinNormals", "SkinNormals"));
  out.set("vector", std::move(normals_));
  out.closeIn();
}

void Skins::writeJoints(NodeStream& out, size_t node) {
  for (auto at = joints_.lower_bound({node, 0}); at != joints_.end() && at->first.first == node;
       at = joints_.erase(at)) {
    Joint& joint = at->second;
    if (joint.vertices.empty()) continue;
    out.open("HAnimJoint", written_.emplace_back(out.define("Joint", "Joint")));
    if (joint.inverseBind != M44d()) writeMatrix(out, joint.inverseBind);
    out.set("skinCoordIndex", std::move(joint.vertices));
    out.set("skinCoordWeight", std::move(joint.weights));
    out.close();
  }
}

void Skins::writeList(NodeStream& out) {
  out.openField("joints");
  for (const std::string_view joint : written_) out.use(joint);
  out.closeField();
  std::erase_if(joints_, [](const auto& joint) { return joint.second.vertices.empty(); });
  if (!joints_.empty())
    file_.locator.warn(nullptr, fmt::format("{} joints of skins are not in their scene; they move "
                                            "nothing",
                                            joints_.size()));
}

} // namespace xvrml::gltf
