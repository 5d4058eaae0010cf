// mesh_file.cpp: counts the memory and the faults of readers of meshes.
#include "parse/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace xvrml {

void Scratch::take(uint64_t bytes) {
  if (share_.take(bytes)) return;
  throw MeshFault{nullptr,
                  fmt::format("reading this mesh takes more memory than {}; the rest of it "
                              "is left out",
                              share_.budget()->name())};
}

void FaultCount::report(Locator& locator, Severity severity, std::string_view message) const {
  if (count_ == 0) return;
  const std::string text = fmt::format("{} {}{}", count_, message,
                                       count_ > 1 && first_ ? "; the first one is here" : "");
  severity == Severity::error ? locator.error(first_, text) : locator.warn(first_, text);
}

void warnIfFar(Locator& locator, double away, double size, std::string_view units) {
  constexpr double part = 1e-4;
  const auto largest = float(std::min(away, double(std::numeric_limits<float>::max())));
  const double step = double(largest) - double(std::nextafter(largest, 0.0f));
  if (!(step > part * size)) return;
  locator.warn(nullptr, fmt::format("points are {:.3g} {} away from the origin, where single "
                                    "precision has steps of {:.2g} {}; the model's size is {:.3g}: "
                                    "move it nearer to the origin",
                                    away, units, step, units, size));
}

PointRange& PointRange::add(const MFVec3f& points) {
  for (const Vec3f& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    if (count_++ == 0) least_ = most_ = p;
    least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y), std::min(least_.z, p.z)};
    most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y), std::max(most_.z, p.z)};
  }
  return *this;
}

void PointRange::report(Locator& locator) const {
  if (count_ < 2) return; // a single point has no size
  double away = 0;
  for (const Vec3f& p : {least_, most_})
    for (const float c : {p.x, p.y, p.z}) away = std::max(away, double(std::abs(c)));
  const auto length = [](float from, float to) { return double(to) - double(from); };
  const double size =
      std::hypot(length(least_.x, most_.x), length(least_.y, most_.y), length(least_.z, most_.z));
  warnIfFar(locator, away, size, "units");
}

} // namespace xvrml
