// weld.cpp: turns corners into vertices. A mesh has one index per vertex, so a point is duplicated
// only where normals, colours or texture coordinates differ between its corners.
#include <algorithm>
#include <array>

#include "geometry/polygons/face_set.h"

namespace xvrml {
namespace {

using Key = std::array<uint32_t, 3>; // normal, texture coordinate, colour

template <class T> bool onePerPoint(const Attribute<T>& attribute, size_t points) {
  return attribute.per == Attribute<T>::Per::none ||
         (attribute.per == Attribute<T>::Per::point && attribute.values.size() >= points);
}

// Returns whether the arrays can be used unchanged: no point needs a duplicate and all points are
// finite.
bool usableInPlace(const FaceSet& set, size_t usedCorners) {
  size_t n = set.points.size();
  return onePerPoint(set.normals, n) && onePerPoint(set.texCoords, n) &&
         onePerPoint(set.colors, n) && n / 4 <= usedCorners && allFinite(set.points);
}

template <class T> void takeAttribute(Attribute<T>& from, size_t points, std::span<const T>& view,
                                      std::vector<T>& own) {
  if (from.per == Attribute<T>::Per::none) return;
  if (from.values.data() == from.own.data()) {
    own = std::move(from.own);
    own.resize(points);
    view = own;
  } else
    view = from.values.first(points);
}

Mesh inPlace(FaceSet&& set, std::span<const uint32_t> triangles) {
  Mesh mesh;
  mesh.ownIndices.resize(triangles.size());
  for (size_t i = 0; i < triangles.size(); i++) mesh.ownIndices[i] = set.corners[triangles[i]];
  size_t points = set.points.size();
  if (set.points.data() == set.ownPoints.data()) {
    mesh.ownPoints = std::move(set.ownPoints);
    mesh.points = mesh.ownPoints;
  } else
    mesh.points = set.points;
  mesh.indices = mesh.ownIndices;
  takeAttribute(set.normals, points, mesh.normals, mesh.ownNormals);
  takeAttribute(set.texCoords, points, mesh.texCoords, mesh.ownTexCoords);
  takeAttribute(set.colors, points, mesh.colors, mesh.ownColors);
  if (!mesh.texCoords.empty() && !set.texPlaces.empty()) {
    mesh.ownTexPlaces = std::move(set.texPlaces);
    mesh.ownTexPlaces.resize(points);
    mesh.texPlaces = mesh.ownTexPlaces;
  }
  mesh.ownFogCoords = std::move(set.fogCoords);
  mesh.fogCoords = mesh.ownFogCoords;
  if (mesh.colors.empty() || set.alphas.empty()) return mesh;
  mesh.ownAlphas = std::move(set.alphas);
  mesh.ownAlphas.resize(points, 1.0f);
  mesh.alphas = mesh.ownAlphas;
  return mesh;
}

class Welder {
 public:
  explicit Welder(const FaceSet& set) : set_(set) {}

  Mesh run(std::span<const uint32_t> triangles) {
    faceOf_ = set_.facesOfCorners();
    std::vector<bool> used(set_.corners.size());
    for (uint32_t corner : triangles) used[corner] = true;
    std::vector<uint32_t> usedCorners, points;
    for (uint32_t corner = 0; corner < set_.corners.size(); corner++)
      if (used[corner]) {
        usedCorners.push_back(corner);
        points.push_back(set_.corners[corner]);
      }
    std::vector<uint32_t> order = orderByPoint(points, set_.points.size());
    for (uint32_t& place : order) place = usedCorners[place];
    vertexOf_.assign(set_.corners.size(), 0);
    for (size_t i = 0, end = 0; i < order.size(); i = end) {
      while (end < order.size() && set_.corners[order[end]] == set_.corners[order[i]]) end++;
      addPoint(std::span(order).subspan(i, end - i));
    }
    mesh_.ownIndices.resize(triangles.size());
    for (size_t i = 0; i < triangles.size(); i++) mesh_.ownIndices[i] = vertexOf_[triangles[i]];
    mesh_.viewOwn();
    return std::move(mesh_);
  }

 private:
  Key keyOf(uint32_t corner) const {
    uint32_t face = faceOf_[corner], point = set_.corners[corner];
    return {set_.normals.at(corner, face, point), set_.texCoords.at(corner, face, point),
            set_.colors.at(corner, face, point)};
  }
  void addPoint(std::span<const uint32_t> corners) {
    keys_.clear();
    for (uint32_t corner : corners) keys_.push_back({keyOf(corner), corner});
    if (keys_.size() > 16) { // sort equal keys together; a few keys are compared directly instead
      std::sort(keys_.begin(), keys_.end());
      uint32_t vertex = 0;
      for (size_t i = 0; i < keys_.size(); i++) {
        if (i == 0 || keys_[i].first != keys_[i - 1].first)
          vertex = addVertex(set_.corners[corners[0]], keys_[i].first);
        vertexOf_[keys_[i].second] = vertex;
      }
      return;
    }
    for (size_t i = 0; i < keys_.size(); i++) {
      size_t same = 0;
      while (keys_[same].first != keys_[i].first) same++;
      vertexOf_[keys_[i].second] = same < i ? vertexOf_[keys_[same].second]
                                            : addVertex(set_.corners[corners[0]], keys_[i].first);
    }
  }

  uint32_t addVertex(uint32_t point, const Key& key) {
    mesh_.ownPoints.push_back(set_.points[point]);
    if (has(set_.normals))
      mesh_.ownNormals.push_back(key[0] == noValue ? Vec3f{0, 0, 1} : set_.normals.values[key[0]]);
    if (has(set_.texCoords))
      mesh_.ownTexCoords.push_back(key[1] == noValue ? Vec2f{0, 0} : set_.texCoords.values[key[1]]);
    if (has(set_.texCoords) && !set_.texPlaces.empty())
      mesh_.ownTexPlaces.push_back(key[1] == noValue ? Vec4f() : set_.texPlaces[key[1]]);
    if (has(set_.colors))
      mesh_.ownColors.push_back(key[2] == noValue ? Color{1, 1, 1} : set_.colors.values[key[2]]);
    if (has(set_.colors) && !set_.alphas.empty())
      mesh_.ownAlphas.push_back(key[2] == noValue ? 1.0f : set_.alphas[key[2]]);
    if (!set_.fogCoords.empty()) mesh_.ownFogCoords.push_back(set_.fogCoords[point]);
    return uint32_t(mesh_.ownPoints.size() - 1);
  }

  template <class T> static bool has(const Attribute<T>& attribute) {
    return attribute.per != Attribute<T>::Per::none;
  }

  const FaceSet& set_;
  std::vector<uint32_t> faceOf_, vertexOf_;
  Mesh mesh_;
  std::vector<std::pair<Key, uint32_t>> keys_;
};

} // namespace

Mesh weld(FaceSet&& set, std::span<const uint32_t> triangles) {
  if (triangles.empty()) return {};
  bool solid = set.solid, ccw = set.ccw;
  Mesh mesh = usableInPlace(set, triangles.size()) ? inPlace(std::move(set), triangles)
                                                   : Welder(set).run(triangles);
  mesh.kind = Mesh::Kind::triangles;
  mesh.solid = solid;
  mesh.ccw = ccw;
  return mesh;
}

} // namespace xvrml
