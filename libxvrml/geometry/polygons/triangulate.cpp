// triangulate.cpp: cuts faces into triangles of corners. Triangles, quadrilaterals and convex faces
// are cut directly. All other faces are tessellated, including faces that break the promise of
// `convex TRUE`.
#include <algorithm>
#include <optional>

#include "geometry/polygons/face_set.h"
#include "geometry/polygons/flat_triangles.h"
#include "geometry/polygons/tessellator.h"

namespace xvrml {
namespace {

class Triangulation {
 public:
  Triangulation(FaceSet& set, std::span<const Vec3f> normals, const MeshOptions& options,
                Faults& faults)
      : set_(set), normals_(normals), faults_(faults),
        limit_(options.limits ? options.limits->triangles : Limits().triangles) {}

  std::vector<uint32_t> run() {
    triangles_.reserve(set_.corners.size() > 2 * size_t(set_.faceCount())
                           ? 3 * (set_.corners.size() - 2 * size_t(set_.faceCount()))
                           : 0);
    crossingBudget_ = set_.corners.size() / 4 + 200'000;
    for (uint32_t face = 0; face < set_.faceCount(); face++) {
      const Vec3f& n = normals_[face];
      if (n.x == 0 && n.y == 0 && n.z == 0) continue; // counted by faceNormals
      if (triangles_.size() / 3 >= limit_) {
        faults_.add(Fault::overLimit, set_.name(face));
        continue;
      }
      addFace(face);
    }
    return std::move(triangles_);
  }

 private:
  V3d point(uint32_t corner) const { return toV3d(set_.points[set_.corners[corner]]); }

  bool isKept(uint32_t a, uint32_t b, uint32_t c) const {
    return hasArea(set_.points[set_.corners[a]], set_.points[set_.corners[b]],
                   set_.points[set_.corners[c]]);
  }

  void add(uint32_t a, uint32_t b, uint32_t c) {
    if (isKept(a, b, c)) triangles_.insert(triangles_.end(), {a, b, c});
  }

  // Returns the sine of the turn at a corner about the face normal, negative where the face is
  // concave.
  double turn(const V3d& normal, uint32_t previous, uint32_t corner, uint32_t next) const {
    V3d a = unit(point(corner) - point(previous)), b = unit(point(next) - point(corner));
    return a.cross(b).dot(normal);
  }

  void addFace(uint32_t face) {
    uint32_t first = set_.faceStart[face], count = set_.faceStart[face + 1] - first;
    V3d normal = toV3d(normals_[face]);
    if (count == 3)
      add(first, first + 1, first + 2);
    else if (count == 4) {
      if (!addQuadrilateral(face, first, normal)) tessellate(face, first, count, normal);
    } else if (isConvex(first, count, normal)) {
      for (uint32_t i = 1; i + 1 < count; i++) add(first, first + i, first + i + 1);
    } else
      tessellate(face, first, count, normal);
  }

  // Cuts a quadrilateral from its concave or straight corner, if any: both triangles then lie
  // inside.
  bool addQuadrilateral(uint32_t face, uint32_t first, const V3d& normal) {
    uint32_t apex = 0;
    if (face >= set_.uncheckedFaces) {
      double sharpest = 1e-6;
      int bent = 0;
      for (uint32_t i = 0; i < 4; i++) {
        double sine = turn(normal, first + (i + 3) % 4, first + i, first + (i + 1) % 4);
        if (sine < -1e-6) bent++;
        if (sine < sharpest) {
          sharpest = sine;
          apex = i;
        }
      }
      if (bent > 1) return false; // it crosses itself
    }
    uint32_t a = first + apex, b = first + (apex + 1) % 4, c = first + (apex + 2) % 4,
             d = first + (apex + 3) % 4;
    add(a, b, c);
    add(a, c, d);
    return true;
  }

  // Returns whether the face is strictly convex and wound once: every corner turns left, and the
  // edges change direction only twice along an axis.
  bool isConvex(uint32_t first, uint32_t count, const V3d& normal) const {
    if (!set_.convex && count > 64) return false; // declared concave: a long test rarely pays
    V3d axis = unit(point(first + 1) - point(first));
    int changes = 0, direction = 0, firstDirection = 0;
    for (uint32_t i = 0; i < count; i++) {
      uint32_t corner = first + i, next = first + (i + 1) % count,
               previous = first + (i + count - 1) % count;
      if (!(turn(normal, previous, corner, next) > 1e-9)) return false;
      double along = (point(next) - point(corner)).dot(axis);
      int now = along > 0 ? 1 : along < 0 ? -1 : direction;
      if (!firstDirection) firstDirection = now;
      if (direction && now != direction) changes++;
      direction = now;
    }
    if (direction != firstDirection) changes++;
    return changes <= 2;
  }

  void tessellate(uint32_t face, uint32_t first, uint32_t count, const V3d& normal) {
    contour_.clear();
    PlaneAxes axes(normal);
    V3d origin = point(first); // keeps coordinates small far from the origin
    for (uint32_t i = 0; i < count; i++)
      contour_.push_back(axes.toPlane(point(first + i) - origin));
    if (!affordable(axes, count)) {
      faults_.add(Fault::tangled, set_.name(face));
      return;
    }
    if (!tessellator_) tessellator_.emplace();
    tessellator_->begin({0, 0, 1}, Tessellator::Winding::odd);
    tessellator_->contour(contour_);
    if (!tessellator_->end()) {
      faults_.add(Fault::tangled, set_.name(face));
      return;
    }
    size_t crossings = tessellator_->crossings().size();
    if (set_.reportCrossed && crossings > 0 && crossesItself(contour_))
      faults_.add(Fault::crossed, set_.name(face));
    crossingBudget_ -= std::min<uint64_t>(crossingBudget_, crossings);
    walkBudget_ -= std::min<uint64_t>(walkBudget_, crossings * count);
    // The tessellator numbers the face's corners, then the crossings, which become corners here.
    uint32_t added = uint32_t(set_.corners.size());
    for (const auto& crossing : tessellator_->crossings())
      addCorner(face, first, count, added, axes.fromPlane(crossing.point) + origin, crossing);
    auto corner = [&](uint32_t vertex) {
      return vertex < count ? first + vertex : added + (vertex - count);
    };
    std::vector<uint32_t> t;
    t.reserve(tessellator_->triangles().size());
    for (const uint32_t vertex : tessellator_->triangles()) t.push_back(corner(vertex));
    removeFlatTriangles(
        t, [&](uint32_t a) { return point(a); },
        [&](uint32_t a, uint32_t b, uint32_t c) { return isKept(a, b, c); });
    triangles_.insert(triangles_.end(), t.begin(), t.end());
  }

  // Checks large polygons first, because the tessellator is quadratic for some of them. It turns
  // the plane by 90 degrees if that means less work.
  bool affordable(PlaneAxes& axes, uint32_t count) {
    if (count < 200) return crossingBudget_ > 0; // quick even if every edge crosses every other
    uint64_t alongX = sweepWork(contour_, 0), alongY = sweepWork(contour_, 1),
             work = std::min(alongX, alongY);
    // Each crossing cuts a loop of edges in two, and the tessellator walks along all of a loop that
    // it cuts.
    const uint64_t crossings = std::min(
        {uint64_t(crossingBudget_), 4 * uint64_t(count) + 20'000, walkBudget_ / uint64_t(count)});
    if (work > sweepBudget_ || isTangled(contour_, crossings)) return false;
    sweepBudget_ -= work;
    if (alongY < alongX) {
      axes.turn();
      for (V3d& p : contour_) p = {p.y, -p.x, p.z};
    }
    return true;
  }

  void addCorner(uint32_t face, uint32_t first, uint32_t count, uint32_t added, const V3d& place,
                 const Tessellator::Crossing& c) {
    uint32_t from[4];
    for (uint32_t i = 0; i < c.count; i++)
      from[i] = c.from[i] < count ? first + c.from[i] : added + (c.from[i] - count);
    auto mean = [&](auto& attribute, auto valueOf, auto finish) {
      using Per = typename std::remove_reference_t<decltype(attribute)>::Per;
      if (attribute.per != Per::point && attribute.per != Per::corner) return;
      if (attribute.per == Per::point) perCorner(attribute);
      uint32_t corners[4];
      for (uint32_t i = 0; i < c.count; i++) corners[i] = attribute.index[from[i]];
      attribute.push(finish(valueOf(attribute.values, corners)));
      attribute.index.push_back(uint32_t(attribute.values.size() - 1));
    };
    mean(
        set_.normals,
        [&](auto values, const uint32_t* at) {
          V3d sum(0, 0, 0);
          for (uint32_t i = 0; i < c.count; i++)
            if (at[i] != noValue) sum += toV3d(values[at[i]]) * c.weight[i];
          return sum;
        },
        [&](const V3d& sum) {
          V3d n = unit(sum);
          return n == V3d(0, 0, 0) ? normals_[face] : toVec3f(n);
        });
    mean(
        set_.texCoords,
        [&](auto values, const uint32_t* at) {
          V2d sum(0, 0);
          Imath::V4d place(0, 0, 0, 0);
          for (uint32_t i = 0; i < c.count; i++) {
            if (at[i] != noValue) sum += V2d(values[at[i]].x, values[at[i]].y) * c.weight[i];
            if (set_.texPlaces.empty()) continue;
            const Vec4f& p = at[i] != noValue ? set_.texPlaces[at[i]] : Vec4f();
            place += Imath::V4d(p.x, p.y, p.z, p.w) * c.weight[i];
          }
          if (!set_.texPlaces.empty())
            set_.texPlaces.push_back(
                {float(place.x), float(place.y), float(place.z), float(place.w)});
          return sum;
        },
        [](const V2d& sum) {
          return Vec2f{float(sum.x), float(sum.y)};
        });
    mean(
        set_.colors,
        [&](auto values, const uint32_t* at) {
          V3d sum(0, 0, 0);
          double alpha = 0;
          for (uint32_t i = 0; i < c.count; i++) {
            Color color = at[i] != noValue ? values[at[i]] : Color{1, 1, 1};
            sum += V3d(color.r, color.g, color.b) * c.weight[i];
            if (!set_.alphas.empty())
              alpha += (at[i] != noValue ? double(set_.alphas[at[i]]) : 1.0) * c.weight[i];
          }
          if (!set_.alphas.empty()) set_.alphas.push_back(float(alpha));
          return sum;
        },
        [](const V3d& sum) {
          return Color{float(sum.x), float(sum.y), float(sum.z)};
        });
    if (!set_.fogCoords.empty()) {
      double share = 0;
      for (uint32_t i = 0; i < c.count; i++)
        share += c.weight[i] * double(set_.fogCoords[set_.corners[from[i]]]);
      set_.fogCoords.push_back(float(share));
    }
    if (set_.points.data() != set_.ownPoints.data())
      set_.ownPoints.assign(set_.points.begin(), set_.points.end());
    set_.ownPoints.push_back(toVec3f(place));
    set_.points = set_.ownPoints;
    set_.corners.push_back(uint32_t(set_.points.size() - 1));
    set_.extraFaces.push_back(face);
  }

  template <class T> void perCorner(Attribute<T>& attribute) {
    attribute.index.resize(set_.corners.size());
    for (size_t corner = 0; corner < set_.corners.size(); corner++)
      attribute.index[corner] =
          set_.corners[corner] < attribute.values.size() ? set_.corners[corner] : noValue;
    attribute.per = Attribute<T>::Per::corner;
  }

  FaceSet& set_;
  std::span<const Vec3f> normals_;
  Faults& faults_;
  uint64_t limit_, crossingBudget_ = 0, sweepBudget_ = 300'000'000, walkBudget_ = 250'000'000;
  std::optional<Tessellator> tessellator_;
  std::vector<V3d> contour_;
  std::vector<uint32_t> triangles_;
};

} // namespace

std::vector<uint32_t> triangulate(FaceSet& set, std::span<const Vec3f> normals,
                                  const MeshOptions& options, Faults& faults) {
  return Triangulation(set, normals, options, faults).run();
}

} // namespace xvrml
