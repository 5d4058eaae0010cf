// thin.cpp: converts lines and points to spheres and round curves. Called by AccelBuilder, on the
// application thread.
#include "backend/local/thin.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "backend/local/accel/bake.h"

namespace openrt {

namespace {

// Splits lines whose ends Embree cannot join by one cone.
//
// * The radius is proportional to the distance from the plane of the eye. A line through this plane
//   has its smallest radius there, not at an end.
// * Embree intersects cones in single precision, and loses those that are much longer than they are
//   far away, or finds them beside their place. A line that is more than 16 times as long as it is
//   far from the eye is cut so that no part is much longer than far away.
class LineSplitter {
 public:
  LineSplitter(const PixelFootprint& footprint, float scale)
      : eye_(Vec3d(footprint.eye) * double(scale)), axis_(footprint.axis),
        perspective_(footprint.slope > 0) {}

  // Returns the places where the line from a to b is cut, as parts of its length in rising order,
  // without 0 and 1. None for most lines, at most 51.
  std::span<const double> cuts(const Vec3d& a, const Vec3d& b) {
    cuts_.clear();
    if (!perspective_) return cuts_; // the radius is the same everywhere
    const Vec3d along = b - a;
    const double whole = length(along);
    if (!(whole > 0 && std::isfinite(whole))) return cuts_;
    const double first = dot(a - eye_, axis_), last = dot(b - eye_, axis_);
    if ((first < 0) != (last < 0)) put(first / (first - last));
    const double nearest = std::clamp(dot(eye_ - a, along) / (whole * whole), 0.0, 1.0);
    const double distance = length(a + along * nearest - eye_) / whole;
    if (distance < 1.0 / 16)
      for (double step = 2 * std::max(distance, 0x1p-26); step < 1; step *= 2) {
        put(nearest - step);
        put(nearest + step);
      }
    std::sort(cuts_.begin(), cuts_.end());
    return cuts_;
  }

 private:
  void put(double cut) {
    if (cut > 0 && cut < 1) cuts_.push_back(cut);
  }
  Vec3d eye_, axis_; // in the space of Embree's scenes
  bool perspective_;
  std::vector<double> cuts_;
};

} // namespace

void addThin(Part& part, const Geometry& g, const Matrix4d& toKernel, uint32_t record,
             const PixelFootprint& footprint, float scale) {
  if (!consistent(g) || !toKernel.usable()) return;
  const std::vector<float> points = bakePoints(g, toKernel);
  const uint32_t* index = g.indices->as<uint32_t>();
  const auto put = [&](const Vec3f& p) {
    const float depth = dot(p / scale - footprint.eye, footprint.axis);
    const float radius =
        0.5f * g.width * (footprint.constant + footprint.slope * std::fabs(depth)) * scale;
    part.vertices.insert(part.vertices.end(), {p.x, p.y, p.z, radius});
  };
  const auto pointOf = [&](uint32_t i) { return vectorOf(points.data() + 3 * size_t(i)); };
  const auto count = uint32_t(g.primitives());
  if (g.primitive != edit::Primitive::Lines) {
    for (uint32_t i = 0; i < count; i++) put(pointOf(index[i]));
    part.primitives.add(record, 0, count);
    return;
  }
  LineSplitter splitter(footprint, scale);
  for (uint32_t i = 0; i < count; i++) {
    const Vec3f a = pointOf(index[2 * i]), b = pointOf(index[2 * i + 1]);
    double from = 0;
    const auto addPiece = [&](const Vec3f& start, const Vec3f& end, double to) {
      if (part.spans.empty() && (from > 0 || to < 1))
        part.spans.resize(part.indices.size(), {0, 1}); // the lines before are whole
      if (from > 0 || to < 1 || !part.spans.empty()) part.spans.push_back({float(from), float(to)});
      part.indices.push_back(uint32_t(part.vertices.size() / 4));
      part.primitives.add(record, i);
      put(start);
      put(end);
      from = to;
    };
    Vec3f start = a;
    for (const double cut : splitter.cuts(Vec3d(a), Vec3d(b))) {
      const Vec3f end(Vec3d(a) + (Vec3d(b) - Vec3d(a)) * cut);
      addPiece(start, end, cut);
      start = end;
    }
    addPiece(start, b, 1);
  }
}

} // namespace openrt
