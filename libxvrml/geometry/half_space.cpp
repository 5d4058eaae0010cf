// half_space.cpp: planes of ClipPlane nodes (ISO/IEC 19775-1 11.4.1).
#include "geometry/half_space.h"

#include <algorithm>
#include <cmath>

namespace xvrml {

std::string faultOf(const nodes::ClipPlane& node) {
  const SFVec4f& p = node.plane;
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(p.w))
    return "plane must be four finite numbers; nothing is cut away";
  if (p.x == 0 && p.y == 0 && p.z == 0)
    return "plane needs a direction: its first three numbers are 0; nothing is cut away";
  return {};
}

std::optional<HalfSpace> halfSpaceOf(const nodes::ClipPlane& node) {
  if (!node.enabled || !faultOf(node).empty()) return std::nullopt;
  // A factor changes nothing, and keeps products with large matrices in range.
  const SFVec4f& p = node.plane;
  const double largest =
      std::max({std::abs(double(p.x)), std::abs(double(p.y)), std::abs(double(p.z))});
  return HalfSpace{{p.x / largest, p.y / largest, p.z / largest}, p.w / largest};
}

HalfSpace inside(const HalfSpace& outside, const Matrix& toOutside) {
  const auto along = [&](int row) {
    return outside.normal.dot({toOutside.x[row][0], toOutside.x[row][1], toOutside.x[row][2]});
  };
  return {{along(0), along(1), along(2)}, along(3) + outside.offset};
}

} // namespace xvrml
