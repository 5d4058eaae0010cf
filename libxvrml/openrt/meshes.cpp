// meshes.cpp: see meshes.h.
#include "openrt/meshes.h"

#include <algorithm>
#include <cmath>

namespace xvrml::mapping {

int32_t Meshes::add(Node& geometry, bool textured) {
  auto [it, fresh] = index_.try_emplace(&geometry, int32_t(entries_.size()));
  if (fresh) {
    entries_.emplace_back();
    entries_.back().geometry = &geometry;
  }
  Entry& entry = entries_[size_t(it->second)];
  entry.textured |= textured;
  ++entry.users;
  return it->second;
}

const Mesh& Meshes::get(int32_t mesh) {
  Entry& entry = entries_[size_t(mesh)];
  if (!entry.built) {
    Diagnostics silent; // what is wrong with a geometry was said when it was built first
    MeshOptions options{entry.textured, &world_.options.limits, entry.known ? &silent : &world_.diagnostics};
    entry.mesh = buildMesh(*entry.geometry, options);
    entry.built = entry.known = true;
    const size_t corners = entry.mesh.indices.size();
    entry.extent.kind = entry.mesh.kind;
    switch (entry.mesh.kind) {
    case Mesh::Kind::empty: entry.extent.primitives = 0; break;
    case Mesh::Kind::triangles: entry.extent.primitives = corners / 3; break;
    case Mesh::Kind::lines: entry.extent.primitives = corners / 2; break;
    case Mesh::Kind::points: entry.extent.primitives = corners; break;
    case Mesh::Kind::sphere: entry.extent.primitives = 1; break;
    }
  }
  return entry.mesh;
}

Meshes::Extent Meshes::extent(int32_t mesh) {
  if (!entries_[size_t(mesh)].known) get(mesh);
  return entries_[size_t(mesh)].extent;
}

void Meshes::release() {
  for (Entry& entry : entries_) {
    entry.mesh = Mesh();
    entry.built = false;
  }
}

void growByPoint(Bounds& bounds, const Vector& p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
  for (int i = 0; i < 3; ++i) {
    bounds.minimum[i] = bounds.empty ? p[i] : std::min(bounds.minimum[i], p[i]);
    bounds.maximum[i] = bounds.empty ? p[i] : std::max(bounds.maximum[i], p[i]);
  }
  bounds.empty = false;
}

void growByBox(Bounds& bounds, const Bounds& box, const Matrix& matrix) {
  if (box.empty) return;
  for (int corner = 0; corner < 8; ++corner) {
    auto side = [&](int axis) { return corner & (1 << axis) ? box.maximum[axis] : box.minimum[axis]; };
    growByPoint(bounds, transformPoint(matrix, {side(0), side(1), side(2)}));
  }
}

void Meshes::grow(Bounds& bounds, int32_t mesh, const Matrix& matrix) {
  const Mesh& m = get(mesh);
  if (m.kind == Mesh::Kind::sphere) {
    // An ellipsoid's extent along a world axis is the length of that row of the linear part.
    const Vector center = transformPoint(matrix, Vector(0));
    Vector reach;
    for (int i = 0; i < 3; ++i) reach[i] = m.radius * Vector(matrix.x[0][i], matrix.x[1][i], matrix.x[2][i]).length();
    growByPoint(bounds, center - reach);
    growByPoint(bounds, center + reach);
    return;
  }
  // A Coordinate node may hold points, perhaps very many, that this geometry does not use.
  if (m.indices.size() < m.points.size()) {
    for (const uint32_t index : m.indices)
      if (index < m.points.size()) growByPoint(bounds, transformPoint(matrix, vector(m.points[index])));
    return;
  }
  std::vector<uint8_t> used(m.points.size());
  for (const uint32_t index : m.indices)
    if (index < used.size()) used[index] = 1;
  for (size_t i = 0; i < used.size(); ++i)
    if (used[i]) growByPoint(bounds, transformPoint(matrix, vector(m.points[i])));
}

void compact(const Mesh& mesh, Mesh& out) {
  std::vector<uint32_t> used(mesh.indices.begin(), mesh.indices.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  while (!used.empty() && used.back() >= mesh.points.size()) used.pop_back();
  out = Mesh();
  out.kind = mesh.kind;
  out.solid = mesh.solid;
  out.ccw = mesh.ccw;
  for (const uint32_t i : used) {
    out.ownPoints.push_back(mesh.points[i]);
    if (!mesh.normals.empty()) out.ownNormals.push_back(mesh.normals[i]);
    if (!mesh.texCoords.empty()) out.ownTexCoords.push_back(mesh.texCoords[i]);
    if (!mesh.colors.empty()) out.ownColors.push_back(mesh.colors[i]);
  }
  out.ownIndices.reserve(mesh.indices.size());
  for (const uint32_t i : mesh.indices)
    out.ownIndices.push_back(uint32_t(std::lower_bound(used.begin(), used.end(), i) - used.begin()));
  out.viewOwn();
}

} // namespace xvrml::mapping
