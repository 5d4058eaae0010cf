// crease.cpp: normals for creaseAngle (clause 4.6.3.5). At each point a face gets a mean of the
// face normals there that differ from its own by less than the crease angle. Each normal is
// weighted by its face's angle at the point (G. Thürmer, C. A. Wüthrich, "Computing Vertex Normals
// from Polygonal Facets", Journal of Graphics Tools 3(1), 1998). The result does not depend on how
// faces are cut into triangles. The cost is linear in the number of corners for any mesh.
#include <algorithm>
#include <atomic>
#include <numbers>

#include "geometry/polygons/face_set.h"
#include "parallel_for.h"

namespace xvrml {
namespace {

// Returns the angle of a face at a corner, accurate to 1e-4; it is used as a weight only. y =
// |cross|, x = dot of the two edges.
float roughAngle(float y, float x) {
  float ax = std::abs(x), ay = std::abs(y);
  float low = std::min(ax, ay), high = std::max(ax, ay);
  if (!(high > 0)) return 0;
  float t = low / high, t2 = t * t;
  // Minimax polynomial of atan on [0, 1] (M. Abramowitz, I. Stegun, 4.4.49, first terms).
  float angle = t * (0.9998660f +
                     t2 * (-0.3302995f + t2 * (0.1801410f + t2 * (-0.0851330f + t2 * 0.0208351f))));
  if (ay > ax) angle = float(std::numbers::pi / 2) - angle;
  return x < 0 ? float(std::numbers::pi) - angle : angle;
}

// Returns the weight of a face at a corner.
float weightOf(const V3f& previous, const V3f& corner, const V3f& next) {
  const V3f a = previous - corner, b = next - corner, product = a.cross(b);
  const float square = product.dot(product);
  // The squares overflow or underflow for very large or small faces, which then get equal weights.
  return square > 1e-30f && std::isfinite(square) ? roughAngle(std::sqrt(square), a.dot(b)) : 1.0f;
}

// Returns the largest square of the chord between unit vectors that is surely within half of the
// crease angle.
float closeLimitOf(float creaseAngle) {
  const double quarter = std::sin(std::min(double(creaseAngle), std::numbers::pi) / 4);
  return float(4 * quarter * quarter * (1 - 1e-5));
}

std::vector<float> cornerAngles(const FaceSet& set) {
  std::vector<float> angles(set.corners.size());
  for (uint32_t face = 0; face < set.faceCount(); face++) {
    uint32_t first = set.faceStart[face], last = set.faceStart[face + 1];
    if (last - first < 3) continue;
    V3f previous = toV3f(set.points[set.corners[last - 1]]),
        current = toV3f(set.points[set.corners[first]]);
    for (uint32_t corner = first; corner < last; corner++) {
      V3f next = toV3f(set.points[set.corners[corner + 1 < last ? corner + 1 : first]]);
      angles[corner] = weightOf(previous, current, next);
      previous = current;
      current = next;
    }
  }
  return angles;
}

struct Member {
  V3f normal;
  float weight;
  uint32_t corner;
};

// Smooths the faces around one point; faces with equal results share a normal.
class PointCrease {
 public:
  PointCrease(FaceSet& set, float creaseAngle) : set_(set) {
    everything_ = creaseAngle >= float(std::numbers::pi);
    double half = std::sin(std::min(double(creaseAngle), std::numbers::pi) / 2);
    limit_ = float(4 * half * half);
    closeLimit_ = closeLimitOf(creaseAngle);
  }

  void process(std::vector<Member>& members) {
    V3f total(0, 0, 0);
    for (const Member& m : members) total += m.normal * m.weight;
    V3f mean = total;
    float length = std::sqrt(total.dot(total));
    if (length > 1e-6f) mean /= length;
    bool together = everything_;
    if (!together &&
        length >
            1e-6f) { // all within half the angle of the mean, so all within the angle of each other
      together = true;
      for (const Member& m : members)
        together = together && (m.normal - mean).dot(m.normal - mean) < closeLimit_;
    }
    if (together)
      assignAll(members, mean, length);
    else if (members.size() <= 64)
      pairwise(members);
    else
      binned(members);
  }

 private:
  // Compares the chord between unit vectors, which separates angles even where the cosine is almost
  // 1.
  bool smooth(const V3f& a, const V3f& b) const {
    return everything_ || (a - b).dot(a - b) < limit_;
  }

  uint32_t emit(const V3f& sum, const V3f& fallback) {
    V3d normal = unit(V3d(sum.x, sum.y, sum.z));
    if (std::sqrt(sum.dot(sum)) < 1e-6f)
      normal = V3d(fallback.x, fallback.y, fallback.z); // opposite faces cancel
    if (!set_.ccw) normal = -normal;
    set_.normals.own.push_back(toVec3f(normal));
    return uint32_t(set_.normals.own.size() - 1);
  }

  void assignAll(const std::vector<Member>& members, const V3f& mean, float length) {
    if (length < 1e-6f) {
      for (const Member& m : members) set_.normals.index[m.corner] = emit(m.normal, m.normal);
      return;
    }
    uint32_t normal = emit(mean, mean);
    for (const Member& m : members) set_.normals.index[m.corner] = normal;
  }

  void pairwise(const std::vector<Member>& members) {
    uint64_t sets[64]; // bit set of the faces that are summed for each face
    for (size_t i = 0; i < members.size(); i++) {
      sets[i] = 0;
      for (size_t k = 0; k < members.size(); k++)
        if (i == k || smooth(members[i].normal, members[k].normal)) sets[i] |= uint64_t(1) << k;
    }
    for (size_t i = 0; i < members.size(); i++) {
      size_t same = 0;
      while (sets[same] != sets[i]) same++;
      V3f sum(0, 0, 0);
      for (size_t k = 0; k < members.size(); k++)
        if (sets[i] >> k & 1) sum += members[k].normal * members[k].weight;
      bool cancels = std::sqrt(sum.dot(sum)) < 1e-6f;
      set_.normals.index[members[i].corner] = same < i && !cancels
                                                  ? set_.normals.index[members[same].corner]
                                                  : emit(sum, members[i].normal);
    }
  }

  // Handles points with very many faces. Cells of a cube map of directions represent the faces, so
  // that the cost stays linear.
  void binned(const std::vector<Member>& members) {
    constexpr int resolution = 8, cells = 6 * resolution * resolution;
    struct Cell {
      V3f sum{0, 0, 0}, direction{0, 0, 0};
      uint32_t normal = noValue;
      bool used = false;
    };
    std::vector<Cell> table(cells);
    auto cellOf = [&](const V3f& n) {
      float size[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
      int axis = int(std::max_element(size, size + 3) - size);
      auto place = [&](float v) {
        return std::clamp(int((v / std::max(size[axis], 1e-6f) + 1) / 2 * resolution), 0,
                          resolution - 1);
      };
      return ((axis * 2 + (n[axis] < 0)) * resolution + place(n[(axis + 1) % 3])) * resolution +
             place(n[(axis + 2) % 3]);
    };
    for (const Member& m : members) {
      Cell& cell = table[cellOf(m.normal)];
      cell.sum += m.normal * m.weight;
      cell.used = true;
    }
    for (Cell& cell : table) {
      V3d direction = unit(V3d(cell.sum.x, cell.sum.y, cell.sum.z));
      cell.direction = V3f(float(direction.x), float(direction.y), float(direction.z));
    }
    for (const Member& m : members) {
      Cell& own = table[cellOf(m.normal)];
      if (own.normal == noValue) {
        V3f sum = own.sum;
        for (Cell& other : table)
          if (&other != &own && other.used && smooth(own.direction, other.direction))
            sum += other.sum;
        own.normal = emit(sum, m.normal);
      }
      set_.normals.index[m.corner] = own.normal;
    }
  }

  FaceSet& set_;
  bool everything_;
  float limit_, closeLimit_;
};

} // namespace

bool smoothNormals(std::span<const Vec3f> points, std::span<const uint32_t> triangles,
                   float creaseAngle, bool ccw, std::vector<Vec3f>& normals) {
  std::vector<V3f> ofFaces(triangles.size() / 3), means(points.size(), V3f(0, 0, 0));
  std::vector<float> weights(triangles.size());
  std::atomic<bool> good{true};
  forRanges(ofFaces.size(), [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; t++) {
      const auto point = [&](size_t k) { return toV3f(points[triangles[3 * t + k % 3]]); };
      const V3d origin(point(0)), edge = V3d(point(1)) - origin;
      ofFaces[t] = toV3f(toVec3f(unit(edge.cross(V3d(point(2)) - origin))));
      if (ofFaces[t] == V3f(0, 0, 0)) good = false;
      for (size_t k = 0; k < 3; k++)
        weights[3 * t + k] = weightOf(point(k + 2), point(k), point(k + 1));
    }
  });
  if (!good) return false;
  // The sums keep the order of the triangles, whatever the number of threads.
  for (size_t i = 0; i < triangles.size(); i++) means[triangles[i]] += ofFaces[i / 3] * weights[i];
  normals.resize(points.size());
  forRanges(points.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
      const float length = std::sqrt(means[i].dot(means[i]));
      if (!(length > 1e-6f)) good = false;
      means[i] /= length;
      const V3d normal = unit(V3d(means[i]));
      normals[i] = toVec3f(ccw ? normal : -normal);
    }
  });
  if (!good || creaseAngle >= float(std::numbers::pi)) return good;
  const float closeLimit = closeLimitOf(creaseAngle);
  forRanges(triangles.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && good; i++) {
      const V3f apart = ofFaces[i / 3] - means[triangles[i]];
      if (!(apart.dot(apart) < closeLimit)) good = false;
    }
  });
  return good;
}

void creaseNormals(FaceSet& set, std::span<const Vec3f> faceNormals) {
  std::vector<uint32_t> faceOf = set.facesOfCorners();
  std::vector<uint32_t> order = orderByPoint(set.corners, set.points.size());
  std::vector<float> angles = cornerAngles(set);
  set.normals.per = Attribute<Vec3f>::Per::corner;
  set.normals.index.assign(set.corners.size(), 0);
  set.normals.own.clear();
  set.normals.own.reserve(std::min(set.points.size() + 16, set.corners.size()));
  set.normals.own.push_back({0, 0, 1}); // for the corners of dropped faces
  PointCrease crease(set, set.creaseAngle);
  std::vector<Member> members;
  for (size_t i = 0; i < order.size();) {
    uint32_t point = set.corners[order[i]];
    members.clear();
    for (; i < order.size() && set.corners[order[i]] == point; i++) {
      const Vec3f& normal = faceNormals[faceOf[order[i]]];
      if (normal.x != 0 || normal.y != 0 || normal.z != 0)
        members.push_back({toV3f(normal), angles[order[i]], order[i]});
    }
    if (!members.empty()) crease.process(members);
  }
  set.normals.values = set.normals.own;
}

} // namespace xvrml
