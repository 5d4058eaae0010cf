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

// Appends to an array that is empty as long as every element has the value `usual`. before: the
// number of elements that are there, or stood for.
template <class T>
void append(std::vector<T>& array, size_t before, const T& usual, const T& value, bool isUsual) {
  if (array.empty() && isUsual) return;
  array.resize(before, usual);
  array.push_back(value);
}

class ThinWriter {
 public:
  ThinWriter(Part& part, const ThinGeometry& thin, const PixelFootprint& footprint, float scale)
      : part_(part), thin_(thin), footprint_(footprint), scale_(scale),
        mostPieces_(std::clamp(0x1p22f / float(thin.geometry.primitives() + 1), 1.0f, 1024.0f)) {}

  // Adds a vertex with the radius that half of the width in pixels has there.
  void addVertex(const Vec3f& p) {
    part_.vertices.insert(part_.vertices.end(), {p.x, p.y, p.z, radiusAt(p)});
  }

  // Adds a part of a line. A ray that passes begins where it has entered, and Embree finds a place
  // on a cone the less exactly the longer it is. So transparent lines become pieces of `longest`
  // radii, that the ray does not enter twice.
  void addPart(uint32_t line, const Vec3f& start, const Vec3f& end, const Part::Span& span,
               bool follows) {
    const float size = std::max(std::min(radiusAt(start), radiusAt(end)) * longest, 1e-30f);
    const float count = thin_.joins ? std::ceil(length(end - start) / size) : 1;
    const int pieces = count > 1 ? int(std::min(count, mostPieces_)) : 1;
    Vec3f from = start;
    float begun = span.from;
    for (int i = 1; i <= pieces; i++) {
      const float place = float(i) / float(pieces);
      const Vec3f to = i < pieces ? start + (end - start) * place : end;
      const float until = i < pieces ? span.from + (span.to - span.from) * place : span.to;
      addPiece(line, from, to, {begun, until}, follows || i > 1);
      from = to;
      begun = until;
    }
  }

 private:
  static constexpr float longest = 16;

  float radiusAt(const Vec3f& p) const {
    const float depth = dot(p / scale_ - footprint_.eye, footprint_.axis);
    const float pixel = footprint_.constant + footprint_.slope * std::fabs(depth);
    return 0.5f * thin_.geometry.width * pixel * scale_;
  }

  // Adds a piece of a line. span: which part of the line it is. follows: it begins where the piece
  // before it ends.
  void addPiece(uint32_t line, const Vec3f& start, const Vec3f& end, const Part::Span& span,
                bool follows) {
    const size_t pieces = part_.indices.size();
    const bool joined = follows && thin_.joins;
    append(part_.spans, pieces, {0, 1}, span, span.from == 0 && span.to == 1);
    if (joined) part_.joints.back() |= RTC_CURVE_FLAG_NEIGHBOR_RIGHT;
    append(part_.joints, pieces, uint8_t(0), uint8_t(joined ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0),
           !thin_.joins);
    if (!joined) addVertex(start);
    part_.indices.push_back(uint32_t(part_.vertices.size() / 4 - 1));
    part_.primitives.add(thin_.record, line);
    addVertex(end);
  }

  Part& part_;
  const ThinGeometry& thin_;
  const PixelFootprint& footprint_;
  float scale_;
  float mostPieces_; // that a part becomes
};

} // namespace

void addThin(Part& part, const ThinGeometry& thin, const PixelFootprint& footprint, float scale) {
  const Geometry& g = thin.geometry;
  if (!consistent(g) || !thin.toKernel.usable()) return;
  const std::vector<float> points = bakePoints(g, thin.toKernel);
  const uint32_t* index = g.indices->as<uint32_t>();
  const auto pointOf = [&](uint32_t i) { return vectorOf(points.data() + 3 * size_t(i)); };
  const auto count = uint32_t(g.primitives());
  ThinWriter writer(part, thin, footprint, scale);
  if (g.primitive != edit::Primitive::Lines) {
    for (uint32_t i = 0; i < count; i++) writer.addVertex(pointOf(index[i]));
    part.primitives.add(thin.record, 0, count);
    return;
  }
  LineSplitter splitter(footprint, scale);
  for (uint32_t i = 0; i < count; i++) {
    const Vec3f a = pointOf(index[2 * i]), b = pointOf(index[2 * i + 1]);
    bool follows = i > 0 && index[2 * i - 1] == index[2 * i];
    Vec3f start = a;
    double from = 0;
    for (const double cut : splitter.cuts(Vec3d(a), Vec3d(b))) {
      const Vec3f end(Vec3d(a) + (Vec3d(b) - Vec3d(a)) * cut);
      writer.addPart(i, start, end, {float(from), float(cut)}, follows);
      follows = true;
      start = end;
      from = cut;
    }
    writer.addPart(i, start, b, {float(from), 1}, follows);
  }
}

} // namespace openrt
