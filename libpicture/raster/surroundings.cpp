#include "libpicture/raster/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libpicture/export/surface.h"
#include "libpicture/export/vertices.h"

namespace picture::raster {

using xvrml::Color;

namespace {

Color mixed(const Color& a, const Color& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

} // namespace

std::vector<Sky::Stop> Sky::stopsOf(const std::vector<Color>& colors,
                                    const std::vector<float>& angles, double most, bool linear) {
  std::vector<Stop> stops;
  const size_t count = std::min(colors.size(), angles.size() + 1);
  for (size_t i = 0; i < count; ++i) {
    const double angle = i == 0 ? 0 : std::min(most, angles[i - 1] > 0 ? double(angles[i - 1]) : 0);
    stops.push_back({i == 0 ? 0 : std::max(angle, stops.back().angle),
                     linear ? linearOf(colors[i]) : colors[i]});
  }
  return stops;
}

Color Sky::at(const std::vector<Stop>& stops, double angle) {
  const auto above = std::upper_bound(stops.begin(), stops.end(), angle,
                                      [](double a, const Stop& stop) { return a < stop.angle; });
  if (above == stops.begin()) return stops.front().color;
  if (above == stops.end()) return stops.back().color;
  const Stop& below = *(above - 1);
  return mixed(below.color, above->color,
               float((angle - below.angle) / (above->angle - below.angle)));
}

template <class T> void Sky::read(const T& node, bool linear) {
  sky_ = stopsOf(node.skyColor, node.skyAngle, std::numbers::pi, linear);
  ground_ = stopsOf(node.groundColor, node.groundAngle, std::numbers::pi / 2, linear);
  if (ground_.size() == 1) ground_.clear(); // it has no extent
  alpha_ = 1 - between0And1(node.transparency);
}

std::optional<Sky> Sky::of(const xvrml::Node& node, const double* matrix, bool linear) {
  Sky sky;
  if (const auto* plain = xvrml::nodeCast<xvrml::nodes::Background>(&node))
    sky.read(*plain, linear);
  else if (const auto* textured = xvrml::nodeCast<xvrml::nodes::TextureBackground>(&node))
    sky.read(*textured, linear);
  else
    return {};
  sky.fromWorld_ = affineOf(matrix).inverse().value_or(Affine());
  return sky;
}

Sky::Seen Sky::along(const Vec& direction) const {
  const Vec local = unit(fromWorld_.vector(direction));
  const double angle = std::atan2(std::hypot(local.x, local.z), local.y),
               above = std::numbers::pi - angle;
  if (!ground_.empty() && above <= ground_.back().angle) return {at(ground_, above), alpha_};
  if (sky_.empty()) return {};
  return {at(sky_, angle), alpha_};
}

template <class T> Haze Haze::from(const T& fog, bool linear) {
  Haze haze;
  haze.color_ = linear ? linearOf(fog.color) : fog.color;
  haze.range_ = fog.visibilityRange;
  haze.exponential_ = fog.fogType == "EXPONENTIAL";
  return haze;
}

std::optional<Haze> Haze::of(const xvrml::Node& node, bool linear) {
  const auto* fog = xvrml::nodeCast<xvrml::nodes::Fog>(&node);
  if (!fog || !(fog->visibilityRange > 0)) return {};
  return from(*fog, linear);
}

std::optional<Haze> Haze::local(const xvrml::Node& node, const xvrml::RenderState& state,
                                bool linear) {
  const auto* fog = xvrml::nodeCast<xvrml::nodes::LocalFog>(&node);
  if (!fog || !fog->enabled) return {};
  Haze haze = from(*fog, linear);
  haze.scope_ = scopeOf(state, false);
  return haze;
}

Color Haze::over(const Color& shape, double distance) const {
  if (!(range_ > 0)) return shape;
  const double left = range_ - distance;
  double clear = 0;
  if (left > 0) clear = exponential_ ? std::exp(-distance / left) : left / range_;
  return mixed(color_, shape, float(clear));
}

} // namespace picture::raster
