// extent.cpp: the box of a mesh, and the steps of floats at its far end.
#include "parse/mesh/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace xvrml {

void MeshExtent::add(std::span<const Vec3f> points) {
  for (const Vec3f& p : points) {
    const float at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; ++k) {
      low_[k] = isEmpty_ ? at[k] : std::min(low_[k], at[k]);
      high_[k] = isEmpty_ ? at[k] : std::max(high_[k], at[k]);
    }
    isEmpty_ = false;
  }
}

void MeshExtent::report(Locator& locator) const {
  constexpr double share = 1e-4;
  double square = 0;
  float furthest = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = double(high_[k]) - double(low_[k]);
    square += side * side;
    furthest = std::max({furthest, std::abs(low_[k]), std::abs(high_[k])});
  }
  if (!std::isfinite(furthest) || !(square > 0)) return; // nothing, a point, or no place at all
  const float next = std::nextafter(furthest, std::numeric_limits<float>::infinity());
  const double step = double(next) - double(furthest), size = std::sqrt(square);
  if (!(step > share * size)) return;
  locator.warn(nullptr, fmt::format("points are {:.3g} units away from the origin, where single "
                                    "precision has steps of {:.2g}, and the model has a size of "
                                    "{:.3g}: its shape is coarse; move it to the origin before it "
                                    "is written",
                                    furthest, step, size));
}

} // namespace xvrml
