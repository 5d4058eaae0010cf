// mesh_checks.h: creates nodes and measures meshes for the tests of libxvrml/geometry.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include "geometry/mesh.h"
#include "xvrml/nodes.h"

namespace xvrml::test {

// A node of a generated type that lives as long as this object.
template <class T> class Made {
 public:
  explicit Made(const char* type) {
    const NodeType* found = findNodeType(type);
    if (found) ref_ = NodeRef(found->create(*found));
    node_ = nodeCast<T>(ref_);
  }
  T* operator->() { return node_; }
  T& operator*() { return *node_; }
  operator NodeRef() const { return ref_; }

 private:
  NodeRef ref_;
  T* node_ = nullptr;
};

inline NodeRef coordinate(MFVec3f points) {
  Made<nodes::Coordinate> node("Coordinate");
  node->point = std::move(points);
  return node;
}
inline NodeRef color(MFColor values) {
  Made<nodes::Color> node("Color");
  node->color = std::move(values);
  return node;
}
inline NodeRef normal(MFVec3f values) {
  Made<nodes::Normal> node("Normal");
  node->vector = std::move(values);
  return node;
}
inline NodeRef textureCoordinate(MFVec2f values) {
  Made<nodes::TextureCoordinate> node("TextureCoordinate");
  node->point = std::move(values);
  return node;
}

struct Built {
  Mesh mesh;
  Diagnostics diagnostics;
};

template <class T> Built build(Made<T>& node, bool textured = false, const Limits& limits = {}) {
  Built built;
  MeshOptions options;
  options.needTexCoords = textured;
  options.limits = &limits;
  options.diagnostics = &built.diagnostics;
  built.mesh = buildMesh(*node, options);
  return built;
}

// Checks the invariants of every mesh, whatever the node contains.
inline void expectSound(const Mesh& mesh) {
  auto finite = [](auto... v) { return (std::isfinite(v) && ...); };
  if (mesh.kind == Mesh::Kind::empty) {
    EXPECT_TRUE(mesh.indices.empty());
    return;
  }
  if (mesh.kind == Mesh::Kind::sphere) {
    EXPECT_TRUE(std::isfinite(mesh.radius) && mesh.radius > 0);
    return;
  }
  size_t corners = mesh.kind == Mesh::Kind::triangles ? 3 : mesh.kind == Mesh::Kind::lines ? 2 : 1;
  EXPECT_EQ(mesh.indices.size() % corners, 0u);
  EXPECT_FALSE(mesh.indices.empty());
  size_t outside = 0, wild = 0, notUnit = 0;
  for (uint32_t index : mesh.indices) outside += index >= mesh.points.size();
  for (const Vec3f& p : mesh.points) wild += !finite(p.x, p.y, p.z);
  for (const Vec2f& p : mesh.texCoords) wild += !finite(p.x, p.y);
  for (const Color& c : mesh.colors) wild += !finite(c.r, c.g, c.b);
  for (const Vec3f& n : mesh.normals)
    notUnit += !(std::abs(std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) - 1) < 1e-4);
  EXPECT_EQ(outside, 0u);
  EXPECT_EQ(wild, 0u);
  EXPECT_EQ(notUnit, 0u);
  for (size_t size : {mesh.normals.size(), mesh.texCoords.size(), mesh.colors.size()})
    EXPECT_TRUE(size == 0 || size == mesh.points.size())
        << size << " beside " << mesh.points.size();
}

using D3 = std::array<double, 3>;
inline D3 at(const Mesh& mesh, size_t corner) {
  const Vec3f& p = mesh.points[mesh.indices[corner]];
  return {p.x, p.y, p.z};
}
inline D3 minus(const D3& a, const D3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline D3 crossProduct(const D3& a, const D3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dotProduct(const D3& a, const D3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double dotProduct(const D3& a, const Vec3f& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}
inline D3 areaVector(const Mesh& mesh, size_t triangle) {
  D3 a = at(mesh, 3 * triangle),
     n = crossProduct(minus(at(mesh, 3 * triangle + 1), a), minus(at(mesh, 3 * triangle + 2), a));
  return {n[0] / 2, n[1] / 2, n[2] / 2};
}

// Returns the volume; positive if the triangles of a closed mesh face outwards.
inline double signedVolume(const Mesh& mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    sum += dotProduct(areaVector(mesh, t), at(mesh, 3 * t)) / 3;
  return mesh.ccw ? sum : -sum;
}

inline double area(const Mesh& mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) {
    D3 n = areaVector(mesh, t);
    sum += std::sqrt(dotProduct(n, n));
  }
  return sum;
}

// Returns the number of edges (by position) that do not have as many edges in the other direction:
// 0 for a watertight mesh.
inline size_t openEdges(const Mesh& mesh) {
  std::map<D3, int> names;
  auto name = [&](size_t corner) {
    return names.emplace(at(mesh, corner), int(names.size())).first->second;
  };
  std::map<std::pair<int, int>, int> count;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    for (size_t e = 0; e < 3; e++) {
      int a = name(3 * t + e), b = name(3 * t + (e + 1) % 3);
      if (a < b) count[{a, b}]++;
      if (a > b) count[{b, a}]--;
    }
  size_t open = 0;
  for (auto& [edge, sum] : count) open += sum != 0;
  return open;
}

// Returns true if the given normals are on the front side of their triangles.
inline bool normalsFaceFront(const Mesh& mesh) {
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    for (size_t e = 0; e < 3; e++) {
      double facing = dotProduct(areaVector(mesh, t), mesh.normals[mesh.indices[3 * t + e]]);
      if (!((mesh.ccw ? facing : -facing) > 0)) return false;
    }
  return true;
}

} // namespace xvrml::test
