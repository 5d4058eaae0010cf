// arc2d.cpp: the points of arcs. A turn has as many segments as a Cylinder (round.h), a shorter arc
// so many that none of its segments is longer.
#include "geometry/arc2d.h"

#include <cmath>
#include <numbers>
#include <string>

#include "geometry/round.h"

namespace xvrml {

bool isDrawable(float size, std::string_view field, Faults& faults) {
  if (size > 0 && std::isfinite(size)) return true;
  faults.note(std::string(field) + " must be positive and finite; nothing is drawn");
  return false;
}

Arc wholeCircle() {
  Arc arc;
  for (int i = 0; i < roundSegments; i++) {
    const Vec2f at = aroundAxis(double(i) / roundSegments); // -sine and -cosine
    arc.points.push_back({0 - at.y, 0 - at.x});
  }
  return arc;
}

std::optional<Arc> arcBetween(float startAngle, float endAngle, Faults& faults) {
  if (!std::isfinite(startAngle) || !std::isfinite(endAngle)) {
    faults.note("startAngle and endAngle must be finite; nothing is drawn");
    return {};
  }
  constexpr double turn = 2 * std::numbers::pi;
  double sweep = double(endAngle) - double(startAngle);
  // The angles are rounded to floats, so that a turn may seem to be slightly less.
  if (sweep == 0 || std::abs(sweep) >= turn * (1 - 1e-7)) return wholeCircle();
  if (sweep < 0) sweep += turn;
  const int segments = std::max(1, int(std::ceil(sweep / turn * roundSegments - 1e-6)));
  Arc arc;
  arc.whole = false;
  for (int i = 0; i <= segments; i++) {
    const double angle = double(startAngle) + sweep * i / segments;
    arc.points.push_back({float(std::cos(angle)), float(std::sin(angle))});
  }
  return arc;
}

} // namespace xvrml
