// face_set.cpp: the sequence of steps from polygons to a mesh, and the short steps.
#include "geometry/polygons/face_set.h"

#include <algorithm>

namespace xvrml {

std::vector<uint32_t> FaceSet::facesOfCorners() const {
  std::vector<uint32_t> faces(corners.size());
  for (uint32_t face = 0; face < faceCount(); face++)
    std::fill(faces.begin() + faceStart[face], faces.begin() + faceStart[face + 1], face);
  if (faceCount())
    std::copy(extraFaces.begin(), extraFaces.end(), faces.begin() + faceStart.back());
  return faces;
}

static bool faceIsFinite(const FaceSet& set, uint32_t face) {
  for (uint32_t corner = set.faceStart[face]; corner < set.faceStart[face + 1]; corner++)
    if (!isFinite(set.points[set.corners[corner]])) return false;
  return true;
}

// Returns the normal of the largest corner triangle. Used where Newell's normal is zero although
// the polygon has area, as for a figure of eight.
static V3d anyNormal(const FaceSet& set, uint32_t first, uint32_t last) {
  V3d origin = toV3d(set.points[set.corners[first]]), best(0, 0, 0);
  for (uint32_t corner = first + 1; corner + 1 < last; corner++) {
    V3d normal = (toV3d(set.points[set.corners[corner]]) - origin)
                     .cross(toV3d(set.points[set.corners[corner + 1]]) - origin);
    if (normal.dot(normal) > best.dot(best)) best = normal;
  }
  return best;
}

std::vector<Vec3f> faceNormals(const FaceSet& set, Faults& faults) {
  std::vector<Vec3f> normals(set.faceCount());
  const bool finite = allFinite(set.points);
  for (uint32_t face = 0; face < set.faceCount(); face++) {
    uint32_t first = set.faceStart[face], last = set.faceStart[face + 1];
    if (last - first < 3) continue;
    if (!finite && !faceIsFinite(set, face)) {
      faults.add(Fault::notFinite, set.name(face));
      continue;
    }
    // Newell's sum of the cross products of successive corners, relative to the first corner to
    // avoid cancellation far from the origin.
    V3d origin = toV3d(set.points[set.corners[first]]), sum(0, 0, 0), previous(0, 0, 0);
    double largest = 0;
    for (uint32_t corner = first + 1; corner < last; corner++) {
      V3d current = toV3d(set.points[set.corners[corner]]) - origin;
      V3d part = previous.cross(current);
      sum += part;
      largest = std::max({largest, std::abs(part.x), std::abs(part.y), std::abs(part.z)});
      previous = current;
    }
    if (last - first > 3 && std::sqrt(sum.dot(sum)) <= 1e-10 * largest)
      sum = anyNormal(set, first, last);
    V3d normal = unit(sum);
    normals[face] = toVec3f(normal);
    if (normal.x == 0 && normal.y == 0 && normal.z == 0 && !set.ignoreNoArea)
      faults.add(Fault::noArea, set.name(face));
  }
  return normals;
}

void repairNormals(FaceSet& set, std::span<const Vec3f> faceNormals, Faults& faults) {
  auto& normals = set.normals;
  using Per = Attribute<Vec3f>::Per;
  auto usable = [&](uint32_t index) {
    if (index == noValue) return false;
    const Vec3f& n = normals.values[index];
    return isFinite(n) && (n.x != 0 || n.y != 0 || n.z != 0);
  };
  bool allUsable = normals.per != Per::point || normals.values.size() >= set.points.size();
  for (size_t i = 0; allUsable && i < normals.values.size(); i++) allUsable = usable(uint32_t(i));
  if (normals.per != Per::point)
    for (size_t i = 0; allUsable && i < normals.index.size(); i++)
      allUsable = normals.index[i] != noValue;

  // Normalise the values once, so that interpolation weights corners equally.
  bool unitLength = true;
  for (const Vec3f& n : normals.values)
    unitLength = unitLength && std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-4f;
  if (!unitLength) {
    for (Vec3f& n : normals.grow()) n = toVec3f(unit(toV3d(n)));
    normals.values = normals.own;
  }
  if (allUsable) return;

  std::vector<uint32_t> index(set.corners.size());
  std::vector<uint32_t> ownOfFace(set.faceCount(), noValue);
  const size_t givenCount = normals.values.size(); // the values grow below
  for (uint32_t face = 0; face < set.faceCount(); face++) {
    for (uint32_t corner = set.faceStart[face]; corner < set.faceStart[face + 1]; corner++) {
      uint32_t given = normals.at(corner, face, set.corners[corner]);
      if (given >= givenCount || !usable(given)) {
        if (ownOfFace[face] == noValue) {
          ownOfFace[face] = uint32_t(normals.values.size());
          Vec3f n = faceNormals[face];
          normals.push(set.ccw ? n : Vec3f{-n.x, -n.y, -n.z});
          if (n.x != 0 || n.y != 0 || n.z != 0) faults.add(Fault::normalMissing, set.name(face));
        }
        given = ownOfFace[face];
      }
      index[corner] = given;
    }
  }
  normals.per = Per::corner;
  normals.index = std::move(index);
}

std::vector<uint32_t> orderByPoint(std::span<const uint32_t> corners, size_t pointCount) {
  std::vector<uint32_t> order(corners.size());
  if (pointCount <= 4 * corners.size() + 1024) { // counting sort
    std::vector<uint32_t> start(pointCount + 1, 0);
    for (uint32_t point : corners) start[point + 1]++;
    for (size_t i = 0; i < pointCount; i++) start[i + 1] += start[i];
    for (uint32_t corner = 0; corner < corners.size(); corner++)
      order[start[corners[corner]]++] = corner;
  } else { // few corners of a large, shared Coordinate
    for (uint32_t corner = 0; corner < corners.size(); corner++) order[corner] = corner;
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return corners[a] < corners[b]; });
  }
  return order;
}

template <class T> static void makeFinite(Attribute<T>& attribute) {
  if (allFinite(attribute.values)) return;
  for (T& value : attribute.grow())
    if (!isFinite(value)) value = T{};
  attribute.values = attribute.own;
}

Mesh buildFaceMesh(FaceSet&& set, const MeshOptions& options, Faults& faults) {
  makeFinite(set.colors);
  makeFinite(set.texCoords);
  std::vector<Vec3f> ofFaces = faceNormals(set, faults);
  if (set.normals.per != Attribute<Vec3f>::Per::none)
    repairNormals(set, ofFaces, faults);
  else if (set.creaseAngle > 0)
    creaseNormals(set, ofFaces);
  std::vector<uint32_t> triangles = triangulate(set, ofFaces, options, faults);
  return weld(std::move(set), triangles);
}

} // namespace xvrml
