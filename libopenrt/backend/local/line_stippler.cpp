// line_stippler.cpp: the size of a pixel is linear along a line, as the weight of a projective map
// is. Lengths in the picture follow from it, also for lines that recede.
#include "backend/local/line_stippler.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "backend/local/accel/bake.h"

namespace openrt {
namespace {

constexpr double reach = 1 << 15; // pixels from the view axis; what is farther away is solid

// A place as the camera sees it: its way from the view axis, and the size of a pixel there.
struct Seen {
  Vec3d aside;
  double pixel;
};

struct Range {
  double from = 0, to = 1;
};

// Returns the part of a line that lies in front of the eye and within reach: in a cone about the
// view axis. No value: nothing does.
std::optional<Range> nearAxis(const Seen& a, const Seen& b) {
  const Vec3d along = b.aside - a.aside;
  const double growth = b.pixel - a.pixel, r2 = reach * reach;
  // Where p2 u^2 + 2 p1 u + p0 <= 0, the place u lies in the cone or in its mirror image.
  const double p2 = dot(along, along) - r2 * growth * growth,
               p1 = dot(a.aside, along) - r2 * a.pixel * growth,
               p0 = dot(a.aside, a.aside) - r2 * a.pixel * a.pixel;
  const double square = p1 * p1 - p2 * p0, root = std::sqrt(std::max(square, 0.0));
  Range range;
  if (p2 > 0) {
    if (square < 0) return std::nullopt;
    range = {std::max(0.0, (-p1 - root) / p2), std::min(1.0, (-p1 + root) / p2)};
  } else if (p2 < 0 && square >= 0) { // it leaves one half of the cone and enters the other
    if (growth > 0)
      range.from = std::max(0.0, (-p1 - root) / p2);
    else
      range.to = std::min(1.0, (-p1 + root) / p2);
  } else if (p2 == 0 && p1 != 0) {
    const double edge = -p0 / (2 * p1);
    if (p1 > 0)
      range.to = std::min(1.0, edge);
    else
      range.from = std::max(0.0, edge);
  }
  const bool isInFront = std::min(a.pixel + range.from * growth, a.pixel + range.to * growth) > 0;
  if (!(range.from < range.to) || !isInFront) return std::nullopt;
  return range;
}

// Returns the line from a to b. phase: cells of the pattern that come before it; then after it.
StippledLine stippled(const Seen& a, const Seen& b, uint16_t factor, double& phase) {
  const std::optional<Range> range = nearAxis(a, b);
  if (!range) return {};
  const auto between = [&](double u) {
    return Seen{a.aside + (b.aside - a.aside) * u, a.pixel + (b.pixel - a.pixel) * u};
  };
  const Seen first = between(range->from), last = between(range->to);
  const double cells = length(last.aside / last.pixel - first.aside / first.pixel) / double(factor);
  if (!std::isfinite(cells)) return {};
  const double begin = phase;
  phase = std::fmod(phase + cells, double(Stipple::cells));
  return {float(range->from), float(range->to), float(begin), float(cells),
          float(first.pixel / last.pixel)};
}

} // namespace

std::vector<StippledLine> stippledLines(const ThinGeometry& thin, const PixelFootprint& footprint,
                                        float scale) {
  const Geometry& g = thin.geometry;
  std::vector<StippledLine> lines;
  if (!consistent(g) || !thin.toKernel.usable()) return lines;
  const std::vector<float> points = bakePoints(g, thin.toKernel);
  const uint32_t* index = g.indices->as<uint32_t>();
  const Vec3d eye(footprint.eye), axis(footprint.axis);
  const auto seen = [&](uint32_t i) {
    const Vec3d way = Vec3d(vectorOf(points.data() + 3 * size_t(i))) / double(scale) - eye;
    const double depth = dot(way, axis);
    return Seen{way - axis * depth, double(footprint.constant) + double(footprint.slope) * depth};
  };
  lines.reserve(g.primitives());
  double phase = 0;
  for (size_t i = 0; i < g.primitives(); i++) {
    if (i > 0 && index[2 * i - 1] != index[2 * i]) phase = 0;
    lines.push_back(stippled(seen(index[2 * i]), seen(index[2 * i + 1]), g.stipple.factor, phase));
  }
  return lines;
}

} // namespace openrt
