// cut.cpp: cuts meshes at planes: each triangle as a polygon at one plane after the other
// (I. Sutherland, G. Hodgman: Reentrant Polygon Clipping, Communications of the ACM 17(1), 1974).
#include <algorithm>
#include <cmath>

#include "geometry/half_space.h"
#include "geometry/sphere_facets.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

// The facets of a sphere that is cut: its silhouette is off by at most 0.03 % of the radius.
constexpr uint32_t sphereRows = 64;

struct Vertex {
  Vector point = Vector(0), normal = Vector(0), color = Vector(1);
  double s = 0, t = 0, alpha = 1, fogCoord = 0;
  Imath::V4d place = Imath::V4d(0); // from texPlaces
  int64_t original = -1;            // index into the mesh; -1: it lies on a plane
};

Vertex between(const Vertex& a, const Vertex& b, double part) {
  const auto mix = [part](const auto& from, const auto& to) { return from + (to - from) * part; };
  Vertex v;
  v.point = mix(a.point, b.point);
  v.normal = mix(a.normal, b.normal);
  v.color = mix(a.color, b.color);
  v.s = mix(a.s, b.s);
  v.t = mix(a.t, b.t);
  v.place = mix(a.place, b.place);
  v.alpha = mix(a.alpha, b.alpha);
  v.fogCoord = mix(a.fogCoord, b.fogCoord);
  return v;
}

bool comesFirst(const Vector& a, const Vector& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// Returns where the edge from a to b meets the plane. It is computed from the same end for all
// triangles that have the edge, so that they meet there exactly.
Vertex crossing(const Vertex& a, double distanceOfA, const Vertex& b, double distanceOfB) {
  return comesFirst(b.point, a.point) ? between(b, a, distanceOfB / (distanceOfB - distanceOfA))
                                      : between(a, b, distanceOfA / (distanceOfA - distanceOfB));
}

class Cutter {
 public:
  Cutter(const Mesh& mesh, std::span<const HalfSpace> halfSpaces, uint64_t most)
      : mesh_(mesh), halfSpaces_(halfSpaces), most_(most), copies_(mesh.points.size(), none) {
    out_.kind = mesh.kind;
    out_.solid = mesh.solid;
    out_.ccw = mesh.ccw;
    out_.texGen = mesh.texGen;
  }

  Cut run(Mesh& result) {
    const uint32_t corners = mesh_.kind == Mesh::Kind::triangles ? 3
                             : mesh_.kind == Mesh::Kind::lines   ? 2
                                                                 : 1;
    findOutside();
    if (std::none_of(mesh_.indices.begin(), mesh_.indices.end(),
                     [&](uint32_t i) { return i < outside_.size() && outside_[i] != 0; }))
      return Cut::whole;
    for (size_t first = 0; first + corners <= mesh_.indices.size(); first += corners) {
      const std::span<const uint32_t> part = mesh_.indices.subspan(first, corners);
      uint32_t some = 0, all = ~0u; // half-spaces that some or all corners are outside of
      for (const uint32_t i : part) {
        const uint32_t outside = i < outside_.size() ? outside_[i] : ~0u; // builders check
        some |= outside;
        all &= outside;
      }
      if (all != 0) continue;
      load(part);
      if (some != 0)
        for (const HalfSpace& halfSpace : halfSpaces_) cutPolygon(halfSpace);
      if (polygon_.size() < corners) continue;
      const uint64_t pieces = corners == 3 ? polygon_.size() - 2 : 1;
      if (out_.ownIndices.size() / corners + pieces > most_) return Cut::tooLarge;
      store(corners);
    }
    if (out_.ownIndices.empty()) return Cut::nothing;
    out_.viewOwn();
    result = std::move(out_);
    return Cut::part;
  }

 private:
  static constexpr uint32_t none = ~0u;

  // Finds for each point the half-spaces that it is outside of: bit k for half-space k.
  void findOutside() {
    outside_.resize(mesh_.points.size());
    for (size_t i = 0; i < outside_.size(); ++i)
      for (size_t k = 0; k < halfSpaces_.size(); ++k) // a NaN is outside
        if (!(halfSpaces_[k].distance(vector(mesh_.points[i])) >= 0)) outside_[i] |= 1u << k;
  }

  void load(std::span<const uint32_t> corners) {
    polygon_.clear();
    for (const uint32_t i : corners) {
      Vertex v;
      v.point = vector(mesh_.points[i]);
      if (!mesh_.normals.empty()) v.normal = vector(mesh_.normals[i]);
      if (!mesh_.texCoords.empty()) {
        v.s = mesh_.texCoords[i].x;
        v.t = mesh_.texCoords[i].y;
      }
      if (!mesh_.texPlaces.empty()) {
        const Vec4f& p = mesh_.texPlaces[i];
        v.place = {p.x, p.y, p.z, p.w};
      }
      if (!mesh_.colors.empty())
        v.color = Vector(mesh_.colors[i].r, mesh_.colors[i].g, mesh_.colors[i].b);
      if (!mesh_.alphas.empty()) v.alpha = mesh_.alphas[i];
      if (!mesh_.fogCoords.empty()) v.fogCoord = mesh_.fogCoords[i];
      v.original = i;
      polygon_.push_back(v);
    }
  }

  // Keeps the part of the polygon, line or point that lies in the half-space.
  void cutPolygon(const HalfSpace& halfSpace) {
    next_.clear();
    const size_t count = polygon_.size();
    for (size_t i = 0; i < count; ++i) {
      const Vertex& v = polygon_[i];
      const double here = halfSpace.distance(v.point); // a NaN is outside
      if (here >= 0) next_.push_back(v);
      if (i + 1 == count && count < 3) break; // a line has no edge back to its start
      const Vertex& w = polygon_[(i + 1) % count];
      const double there = halfSpace.distance(w.point);
      if ((here > 0 && there < 0) || (here < 0 && there > 0))
        next_.push_back(crossing(v, here, w, there));
    }
    polygon_.swap(next_);
  }

  uint32_t add(const Vertex& v) {
    const auto index = uint32_t(out_.ownPoints.size());
    if (v.original >= 0) {
      uint32_t& copy = copies_[size_t(v.original)];
      if (copy != none) return copy;
      copy = index;
    }
    out_.ownPoints.push_back(toVec3f(v.point));
    if (!mesh_.normals.empty()) out_.ownNormals.push_back(toVec3f(v.normal));
    if (!mesh_.texCoords.empty()) out_.ownTexCoords.push_back({float(v.s), float(v.t)});
    if (!mesh_.texPlaces.empty())
      out_.ownTexPlaces.push_back(
          {float(v.place.x), float(v.place.y), float(v.place.z), float(v.place.w)});
    if (!mesh_.colors.empty())
      out_.ownColors.push_back({float(v.color.x), float(v.color.y), float(v.color.z)});
    if (!mesh_.alphas.empty()) out_.ownAlphas.push_back(float(v.alpha));
    if (!mesh_.fogCoords.empty()) out_.ownFogCoords.push_back(float(v.fogCoord));
    return index;
  }

  void store(uint32_t corners) {
    std::vector<uint32_t>& to = out_.ownIndices;
    if (corners < 3) {
      for (const Vertex& v : polygon_) to.push_back(add(v));
      return;
    }
    const uint32_t first = add(polygon_[0]);
    uint32_t before = add(polygon_[1]);
    for (size_t i = 2; i < polygon_.size(); ++i) {
      const uint32_t here = add(polygon_[i]);
      to.insert(to.end(), {first, before, here});
      before = here;
    }
  }

  const Mesh& mesh_;
  std::span<const HalfSpace> halfSpaces_;
  uint64_t most_;
  std::vector<uint32_t> outside_; // by vertex of the mesh: findOutside
  std::vector<uint32_t> copies_;  // by vertex of the mesh: its index in the result
  std::vector<Vertex> polygon_, next_;
  Mesh out_;
};

// Returns the facets of a sphere of radius 1.
const Mesh& unitFacets() {
  static const Mesh facets = sphereFacets(1, sphereRows);
  return facets;
}

// Spheres that no plane meets stay spheres, or go, at the cost of a few products.
Cut cutSphere(const Mesh& sphere, std::span<const HalfSpace> halfSpaces, uint64_t most,
              Mesh& result) {
  bool whole = true;
  for (const HalfSpace& halfSpace : halfSpaces) {
    const double reach = halfSpace.normal.length() * sphere.radius;
    if (!(halfSpace.offset >= -reach)) return Cut::nothing; // a NaN leaves nothing
    whole &= halfSpace.offset >= reach;
  }
  if (whole) return Cut::whole;
  if (most < uint64_t(4) * sphereRows * sphereRows) return Cut::tooLarge;
  const Mesh& unit = unitFacets();
  Mesh facets;
  facets.kind = Mesh::Kind::triangles;
  facets.solid = sphere.solid;
  facets.points = unit.points;
  facets.indices = unit.indices;
  facets.normals = unit.normals;
  facets.texCoords = unit.texCoords;
  if (sphere.radius != 1) {
    for (const Vec3f& p : unit.points)
      facets.ownPoints.push_back({sphere.radius * p.x, sphere.radius * p.y, sphere.radius * p.z});
    facets.points = facets.ownPoints;
  }
  return Cutter(facets, halfSpaces, most).run(result);
}

} // namespace

Cut cut(const Mesh& mesh, std::span<const HalfSpace> halfSpaces, uint64_t most, Mesh& result) {
  result = Mesh();
  if (mesh.kind == Mesh::Kind::empty) return Cut::nothing;
  if (halfSpaces.empty()) return Cut::whole;
  if (most == 0) return Cut::tooLarge;
  return mesh.kind == Mesh::Kind::sphere ? cutSphere(mesh, halfSpaces, most, result)
                                         : Cutter(mesh, halfSpaces, most).run(result);
}

} // namespace xvrml
