// extrusion.cpp: Extrusion (clause 6.18): a cross-section swept along a spine, and its caps.
#include <algorithm>

#include "geometry/builders.h"
#include "geometry/extrusion_frames.h"
#include "geometry/polygons/face_set.h"

namespace xvrml {
namespace {

V3d rotate(const Rotation& r, const V3d& v) {
  V3d axis = unit(V3d(r.x, r.y, r.z));
  if (axis == V3d(0, 0, 0) || !std::isfinite(r.angle)) return v;
  double c = std::cos(double(r.angle)), s = std::sin(double(r.angle));
  return v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1 - c));
}

class Sweep {
 public:
  Sweep(const nodes::Extrusion& node, const MeshOptions& options, Faults& faults)
      : node_(node), options_(options), faults_(faults), spine_(node.spine),
        section_(node.crossSection) {}

  Mesh run() {
    if (spine_.size() < 2 || section_.size() < 2) {
      faults_.note("spine and crossSection need two points at least; nothing is drawn");
      return {};
    }
    if (!allFinite(std::span<const Vec3f>(spine_)) ||
        !allFinite(std::span<const Vec2f>(section_))) {
      faults_.note("spine or crossSection is not finite; nothing is drawn");
      return {};
    }
    // In 64 bits, because each size is below 2^32.
    uint64_t points = uint64_t(spine_.size()) * section_.size() + 2 * section_.size();
    if (points > triangleLimit(options_) / 2 + 4 || points >= noValue / 4) {
      faults_.note("more triangles than " + std::string(triangleLimitName(options_)) +
                   " allows; nothing is drawn");
      return {};
    }
    closedSection_ = section_.size() > 2 && section_.front() == section_.back();
    closedSpine_ = spine_.size() > 2 && spine_.front() == spine_.back();
    makePoints();
    // Ends that meet share one row of points, so that creases are smoothed across the seam.
    joined_ = closedSpine_ && std::equal(row(0), row(0) + columns_, row(rows_ - 1));
    if (joined_) set_.ownPoints.resize((rows_ - 1) * columns_);
    makeSides();
    if (!joined_) {
      if (node_.beginCap) makeCap(0, true);
      if (node_.endCap) makeCap(rows_ - 1, false);
    }
    set_.points = set_.ownPoints;
    set_.texCoords.values = set_.texCoords.own;
    set_.solid = node_.solid;
    set_.ccw = node_.ccw;
    set_.convex = node_.convex;
    set_.creaseAngle = node_.creaseAngle;
    set_.ignoreNoArea = true; // scale 0 makes a tip, which is valid
    return buildFaceMesh(std::move(set_), options_, faults_);
  }

 private:
  // If scale or orientation has too few values, the last one is repeated.
  template <class T> static T valueAt(const std::vector<T>& values, size_t i, const T& otherwise) {
    return values.empty() ? otherwise : values[std::min(i, values.size() - 1)];
  }
  const Vec3f* row(size_t i) const { return set_.ownPoints.data() + i * columns_; }

  void makePoints() {
    rows_ = spine_.size();
    columns_ = closedSection_ ? section_.size() - 1 : section_.size();
    std::vector<SpineFrame> frames = spineFrames(spine_, closedSpine_);
    set_.ownPoints.reserve(rows_ * columns_);
    for (size_t i = 0; i < rows_; i++) {
      Vec2f scale = valueAt(node_.scale, i, Vec2f{1, 1});
      Rotation turn = valueAt(node_.orientation, i, Rotation{});
      const SpineFrame& frame = frames[i];
      V3d x = rotate(turn, {1, 0, 0}), z = rotate(turn, {0, 0, 1}), origin = toV3d(spine_[i]);
      auto inFrame = [&](const V3d& v) { return frame.x * v.x + frame.y * v.y + frame.z * v.z; };
      x = inFrame(x) * scale.x;
      z = inFrame(z) * scale.y;
      for (size_t j = 0; j < columns_; j++)
        set_.ownPoints.push_back(
            toVec3f(origin + x * double(section_[j].x) + z * double(section_[j].y)));
    }
  }

  void addFace(std::initializer_list<std::pair<uint32_t, uint32_t>> pointsAndTexCoords) {
    for (auto [point, texCoord] : pointsAndTexCoords) {
      set_.corners.push_back(point);
      if (options_.needTexCoords) set_.texCoords.index.push_back(texCoord);
    }
    set_.faceStart.push_back(uint32_t(set_.corners.size()));
  }

  void makeSides() {
    size_t steps = section_.size();
    if (options_.needTexCoords) { // S along the cross-section, T along the spine
      set_.texCoords.per = Attribute<Vec2f>::Per::corner;
      for (size_t i = 0; i < rows_; i++)
        for (size_t j = 0; j < steps; j++)
          set_.texCoords.own.push_back(
              {float(double(j) / double(steps - 1)), float(double(i) / double(rows_ - 1))});
    }
    set_.faceStart.push_back(0);
    size_t realRows = joined_ ? rows_ - 1 : rows_;
    for (size_t i = 0; i + 1 < rows_; i++)
      for (size_t j = 0; j + 1 < steps; j++) {
        auto corner = [&](size_t r, size_t c) {
          return std::pair{uint32_t((r % realRows) * columns_ + c % columns_),
                           uint32_t(r * steps + c)};
        };
        addFace({corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)});
      }
    set_.uncheckedFaces = set_.faceCount();
  }

  // Adds a cap. It has points of its own: its normal is along the spine and never smoothed into the
  // sides.
  void makeCap(size_t rowIndex, bool begin) {
    size_t count = columns_;
    if (count < 3) return;
    uint32_t firstPoint = uint32_t(set_.ownPoints.size()),
             firstTexCoord = uint32_t(set_.texCoords.own.size());
    for (size_t j = 0; j < count; j++) set_.ownPoints.push_back(Vec3f(row(rowIndex)[j]));
    if (options_.needTexCoords) { // the cross-section itself; its larger side runs from 0 to 1
      Vec2f low = section_[0], high = section_[0];
      for (const Vec2f& p : section_) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
      double size = std::max(double(high.x) - low.x, double(high.y) - low.y);
      for (size_t j = 0; j < count; j++)
        set_.texCoords.own.push_back(size > 0 ? Vec2f{float((double(section_[j].x) - low.x) / size),
                                                      float((double(section_[j].y) - low.y) / size)}
                                              : Vec2f{});
    }
    size_t before = set_.corners.size();
    for (size_t j = 0; j < count; j++) {
      uint32_t at = uint32_t(begin ? count - 1 - j : j);
      const auto& p = set_.ownPoints;
      if (set_.corners.size() > before && p[set_.corners.back()] == p[firstPoint + at]) continue;
      set_.corners.push_back(firstPoint + at);
      if (options_.needTexCoords) set_.texCoords.index.push_back(firstTexCoord + at);
    }
    set_.faceStart.push_back(uint32_t(set_.corners.size()));
  }

  const nodes::Extrusion& node_;
  const MeshOptions& options_;
  Faults& faults_;
  const MFVec3f& spine_;
  const MFVec2f& section_;
  bool closedSection_ = false, closedSpine_ = false, joined_ = false;
  size_t rows_ = 0, columns_ = 0;
  FaceSet set_;
};

} // namespace

Mesh buildExtrusion(const nodes::Extrusion& node, const MeshOptions& options, Faults& faults) {
  return Sweep(node, options, faults).run();
}

} // namespace xvrml
