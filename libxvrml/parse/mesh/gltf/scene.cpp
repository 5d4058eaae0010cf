// scene.cpp: the transformation hierarchy of a glTF file.
#include "parse/mesh/gltf/scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <Imath/ImathMatrixAlgo.h>
#include <fmt/format.h>

namespace xvrml::gltf {

using Imath::M33d;
using Imath::M44d;
using Imath::V3d;

namespace {

Vec3f vec3f(const V3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

V3d vectorOf(const std::vector<double>& numbers, const V3d& fallback) {
  return numbers.empty() ? fallback : V3d(numbers[0], numbers[1], numbers[2]);
}

// Imath's matrices are those of row vectors, so that the 16 numbers of glTF's columns are its rows.
M44d matrix44(const double* m) {
  M44d out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = m[i];
  return out;
}

Rotation rotationOf(const M33d& m) {
  const Imath::Quatd q =
      Imath::extractQuat(M44d(m[0][0], m[0][1], m[0][2], 0, m[1][0], m[1][1], m[1][2], 0, m[2][0],
                              m[2][1], m[2][2], 0, 0, 0, 0, 1));
  return gltf::rotationOf(q.v.x, q.v.y, q.v.z, q.r);
}

// Returns the axis along which a scale is 0, or -1 if there is none or more than one.
int flatAxis(const double (&scale)[3]) {
  int axis = -1, zeros = 0;
  for (int i = 0; i < 3; ++i)
    if (scale[i] == 0) {
      axis = i;
      ++zeros;
    }
  return zeros == 1 ? axis : -1;
}

double flatSize(const double (&scale)[3]) {
  return flatness * std::max({std::abs(scale[0]), std::abs(scale[1]), std::abs(scale[2])});
}

} // namespace

// A matrix without shear has its columns' lengths
// as scale. Any other is a rotation times a symmetric matrix (polar decomposition), whose
// eigenvectors are scaleOrientation.
void writeMatrix(NodeStream& out, const M44d& m) {
  out.set("translation", vec3f({m[3][0], m[3][1], m[3][2]}));
  V3d rows[3];
  double lengths[3];
  for (int i = 0; i < 3; ++i) {
    rows[i] = {m[i][0], m[i][1], m[i][2]};
    lengths[i] = rows[i].length();
  }
  if (const int axis = flatAxis(lengths); axis >= 0) {
    const V3d across = rows[(axis + 1) % 3].cross(rows[(axis + 2) % 3]).normalized();
    rows[axis] = across * flatSize(lengths);
    lengths[axis] = rows[axis].length();
  }
  const bool flipped = rows[0].dot(rows[1].cross(rows[2])) < 0;
  if (flipped) lengths[0] = -lengths[0];
  bool sheared = false, singular = false;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3;
    const double both = std::abs(lengths[i] * lengths[k]);
    singular = singular || !(both > 0) || !std::isfinite(both);
    sheared = sheared || std::abs(rows[i].dot(rows[k])) > 1e-6 * both;
  }
  if (singular) { // nothing of it has any size
    out.set("scale", vec3f({lengths[0], lengths[1], lengths[2]}));
    return;
  }
  if (!sheared) {
    for (int i = 0; i < 3; ++i) rows[i] /= lengths[i];
    out.set("rotation", rotationOf(M33d(rows[0].x, rows[0].y, rows[0].z, rows[1].x, rows[1].y,
                                        rows[1].z, rows[2].x, rows[2].y, rows[2].z)));
    out.set("scale", vec3f({lengths[0], lengths[1], lengths[2]}));
    return;
  }
  M33d linear, u, v;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) linear[i][k] = m[i][k];
  V3d s;
  Imath::jacobiSVD(linear, u, s, v, std::numeric_limits<double>::epsilon(), true);
  // For row vectors p linear = p (U S U^T) (U V^T): the symmetric matrix acts first.
  out.set("rotation", rotationOf(u * v.transposed()));
  out.set("scaleOrientation", rotationOf(u.transposed()));
  out.set("scale", vec3f(s));
}

Rotation rotationOf(double x, double y, double z, double w) {
  const double axis = std::sqrt(x * x + y * y + z * z);
  if (!(axis > 0) || !std::isfinite(axis) || !std::isfinite(w)) return {};
  return {float(x / axis), float(y / axis), float(z / axis), float(2 * std::atan2(axis, w))};
}

Scene::Scene(const MeshFile& file, NodeStream& nodes, const Item& root, Accessors& accessors)
    : file_(file), out_(nodes), scratch_(file.budget), materials_(file, nodes, root, accessors),
      primitives_(file, nodes, root, accessors, materials_), nodes_(root.list("nodes")),
      scenes_(root.list("scenes")), cameras_(root.list("cameras")),
      lights_(root.extension("KHR_lights_punctual").list("lights")),
      skins_(file, root, accessors, nodes_.size()), scene_(root.index("scene", scenes_.size())),
      children_(nodes_.size()), parents_(nodes_.size(), nodes_.size()), defs_(nodes_.size()),
      hasMorphAnimation_(nodes_.size()), hasScaleAnimation_(nodes_.size()),
      inThisScene_(nodes_.size()) {
  findParents();
  findAnimated(root);
}

// Nodes form trees (3.5.2). A second parent, or one of its own descendants, is refused.
void Scene::findParents() {
  std::vector<size_t> above(nodes_.size()); // an ancestor of each node; the root itself
  std::iota(above.begin(), above.end(), size_t(0));
  const auto rootOf = [&](size_t node) {
    for (; above[node] != node; node = above[node]) above[node] = above[above[node]];
    return node;
  };
  for (size_t i = 0; i < nodes_.size(); ++i) {
    for (const size_t child : nodes_[i].indices("children", nodes_.size())) {
      if (parents_[child] != nodes_.size() || rootOf(i) == child) {
        nodes_[i].error(fmt::format("node {} has a parent already, or is its own ancestor; it is "
                                    "left out here",
                                    child));
        continue;
      }
      parents_[child] = above[child] = i;
      children_[i].push_back(child);
    }
  }
}

void Scene::findAnimated(const Item& root) {
  for (const Item& animation : root.list("animations")) {
    for (const Item& channel : animation.list("channels")) {
      const Item target = channel.object("target");
      const std::string path = target.text("path");
      std::vector<bool>* const has = path == "weights" ? &hasMorphAnimation_
                                     : path == "scale" ? &hasScaleAnimation_
                                                       : nullptr;
      const auto node = has ? target.index("node", nodes_.size()) : std::nullopt;
      if (node) (*has)[*node] = true;
    }
  }
}

std::vector<size_t> Scene::rootsOf(const Item& scene) const {
  return scene.indices("nodes", nodes_.size());
}

void Scene::write() {
  if (scenes_.empty()) { // a library of meshes
    std::vector<size_t> roots;
    for (size_t i = 0; i < nodes_.size(); ++i)
      if (parents_[i] == nodes_.size()) roots.push_back(i);
    writeRoots(roots);
    for (size_t i = 0; nodes_.empty() && i < primitives_.size(); ++i) primitives_.write(i, {});
  } else if (scenes_.size() == 1) {
    writeRoots(rootsOf(scenes_[0]));
  } else {
    out_.open("Switch", out_.define("Scenes", {}));
    out_.set("whichChoice", int32_t(scene_.value_or(0)));
    out_.openField("children");
    for (const Item& scene : scenes_) {
      out_.open("Group", out_.define(scene.text("name"), "Scene"));
      out_.openField("children");
      writeRoots(rootsOf(scene));
      out_.closeField();
      out_.close();
    }
    out_.closeField();
    out_.close();
  }
}

void Scene::writeRoots(const std::vector<size_t>& roots) {
  std::fill(inThisScene_.begin(), inThisScene_.end(), false);
  skinned_.clear();
  findSkinned(roots);
  skins_.beginFigure();
  for (const auto& [node, skinned] : skinned_)
    if (skinned.mesh) primitives_.addTo(deformationOf(node), *skinned.mesh);
  if (!skins_.empty()) return writeFigure(roots);
  for (const size_t root : roots) writeNode(root, 1);
  writeSkinned(); // points alone
}

// Finds the nodes of the next scene that have a mesh with a skin and are not written yet.
void Scene::findSkinned(const std::vector<size_t>& roots) {
  std::vector<bool> seen(nodes_.size());
  std::vector<size_t> open(roots.rbegin(), roots.rend());
  while (!open.empty()) {
    const size_t number = open.back();
    open.pop_back();
    if (!nodes_[number] || seen[number] || !defs_[number].empty()) continue;
    seen[number] = true;
    if (const auto skin = nodes_[number].index("skin", skins_.size()))
      skinned_[number] = {nodes_[number].index("mesh", primitives_.size()), *skin};
    open.insert(open.end(), children_[number].rbegin(), children_[number].rend());
  }
}

// Writes the scene as the skeleton of a figure. Meshes with skins are the skin, because their
// joints alone place them (3.7.3.1).
void Scene::writeFigure(const std::vector<size_t>& roots) {
  out_.open("HAnimHumanoid", out_.define("Figure", {}));
  skins_.writeVertices(out_);
  out_.openField("skeleton");
  for (const size_t root : roots) writeNode(root, 1);
  out_.closeField();
  out_.openField("skin");
  writeSkinned();
  out_.closeField();
  skins_.writeList(out_);
  out_.close();
}

void Scene::writeSkinned() {
  for (const auto& [node, skinned] : skinned_)
    if (skinned.mesh) primitives_.write(*skinned.mesh, deformationOf(node));
}

Deformation Scene::deformationOf(size_t number) {
  return {weightsOf(nodes_[number]), &skins_, number, skinned_.at(number).skin};
}

void Scene::writeNode(size_t number, uint64_t depth) {
  const Item& node = nodes_[number];
  if (!node) return;
  const uint64_t limit = file_.options.limits.nesting;
  if (depth > limit) return node.error(fmt::format("nodes deeper than limit nesting={}", limit));
  if (inThisScene_[number]) return node.error("the node stands twice in its scene");
  inThisScene_[number] = true;
  if (!defs_[number].empty()) return out_.use(defs_[number]); // several scenes may show a node
  defs_[number] = out_.define(node.text("name"), "Node");
  out_.open("Transform", defs_[number]);
  writePlace(node);
  out_.openField("children");
  writeMesh(number);
  skins_.writeJoints(out_, number);
  if (const auto camera = node.index("camera", cameras_.size()))
    gltf::writeCamera(out_, cameras_[*camera]);
  writeLight(number);
  for (const size_t child : children_[number]) writeNode(child, depth + 1);
  out_.closeField();
  out_.close();
}

void Scene::writePlace(const Item& node) {
  if (const auto m = node.numbers("matrix", 16); !m.empty())
    return writeMatrix(out_, matrix44(m.data()));
  const auto t = node.numbers("translation", 3), r = node.numbers("rotation", 4),
             s = node.numbers("scale", 3);
  if (!t.empty()) out_.set("translation", vec3f(vectorOf(t, {})));
  if (!r.empty()) out_.set("rotation", gltf::rotationOf(r[0], r[1], r[2], r[3]));
  if (s.empty()) return;
  const V3d given = vectorOf(s, {});
  double scale[3] = {given.x, given.y, given.z};
  if (const int axis = flatAxis(scale); axis >= 0) scale[axis] = flatSize(scale);
  out_.set("scale", vec3f({scale[0], scale[1], scale[2]}));
}

void Scene::writeLight(size_t number) {
  const Item& node = nodes_[number];
  const auto light = node.extension("KHR_lights_punctual").index("light", lights_.size());
  if (!light) return;
  for (size_t above = number; above != nodes_.size(); above = parents_[above]) {
    if (!hasScaleAnimation_[above]) continue;
    node.warn("an animation scales a light, and its distances with it");
    break;
  }
  gltf::writeLight(out_, lights_[*light], worldMatrix(number));
}

M44d Scene::matrixOf(const Item& node) const {
  if (const auto m = node.numbers("matrix", 16); !m.empty()) return matrix44(m.data());
  const auto t = node.numbers("translation", 3), r = node.numbers("rotation", 4),
             s = node.numbers("scale", 3);
  M44d scale, move;
  if (!s.empty()) scale.setScale(vectorOf(s, {1, 1, 1}));
  if (!t.empty()) move.setTranslation(vectorOf(t, {}));
  M44d turn;
  if (!r.empty()) turn = Imath::Quatd(r[3], r[0], r[1], r[2]).normalized().toMatrix44();
  return scale * turn * move;
}

// Returns the matrix from a node to the scene.
const M44d& Scene::worldMatrix(size_t node) {
  std::vector<size_t> path;
  for (size_t above = node; above != nodes_.size() && !worlds_.contains(above);
       above = parents_[above])
    path.push_back(above);
  scratch_.take(path.size() * 2 * sizeof(M44d));
  for (; !path.empty(); path.pop_back()) {
    const size_t next = path.back();
    const auto parent = worlds_.find(parents_[next]);
    const M44d own = matrixOf(nodes_[next]);
    worlds_.emplace(next, parent == worlds_.end() ? own : own * parent->second);
  }
  return worlds_.at(node);
}

std::vector<double> Scene::weightsOf(const Item& node) const {
  std::vector<double> weights = node.numbers("weights");
  const auto mesh = node.index("mesh", primitives_.size());
  if (weights.empty() && mesh) weights = primitives_.mesh(*mesh).numbers("weights");
  if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; })) weights.clear();
  return weights;
}

void Scene::writeMesh(size_t number) {
  const Item& node = nodes_[number];
  if (skinned_.contains(number)) return; // part of the figure
  const auto mesh = node.index("mesh", primitives_.size());
  if (!mesh) return;
  primitives_.keepMorphs(hasMorphAnimation_[number]);
  primitives_.write(*mesh, {weightsOf(node)});
  if (hasMorphAnimation_[number]) morphs_[number] = primitives_.takeMorphs();
  primitives_.keepMorphs(false);
}

const std::vector<Primitives::Morph>* Scene::morphsOf(size_t node) const {
  const auto found = morphs_.find(node);
  return found == morphs_.end() ? nullptr : &found->second;
}

} // namespace xvrml::gltf
