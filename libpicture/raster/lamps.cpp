#include "libpicture/raster/lamps.h"

#include <algorithm>
#include <cmath>

#include "libpicture/export/surface.h"

namespace picture::raster {

using xvrml::Color;
using xvrml::Node;
using xvrml::RenderState;

namespace {

Vec vecOf(const xvrml::Vec3f& v) { return {v.x, v.y, v.z}; }

Color scaled(const Color& c, double factor) {
  return {float(c.r * factor), float(c.g * factor), float(c.b * factor)};
}

double notNegative(double v) { return v > 0 ? v : 0; }

} // namespace

GroupPath scopeOf(const RenderState& state, bool global) {
  const auto leaves = [&](const Node& above) {
    return global ? !xvrml::inlineScope(above)
                  : xvrml::nodeCast<xvrml::ProtoInstance>(&above) != nullptr;
  };
  size_t count = state.path.size() - 1;
  while (count > 0 && leaves(*state.path[count - 1])) --count;
  return {state.path.begin(), state.path.begin() + ptrdiff_t(count)};
}

bool isWithin(const GroupPath& scope, const RenderState& shape) {
  return shape.path.size() >= scope.size() &&
         std::equal(scope.begin(), scope.end(), shape.path.begin());
}

template <class T> void Lamp::setLight(const T& light, bool linear) {
  const Color color = linear ? linearOf(light.color) : light.color;
  direct_ = scaled(color, notNegative(light.intensity));
  ambient_ = scaled(color, notNegative(light.ambientIntensity));
}

template <class T> void Lamp::setPlaced(const T& light, bool linear) {
  setLight(light, linear);
  location_ = vecOf(light.location);
  attenuation_ = {notNegative(light.attenuation.x), notNegative(light.attenuation.y),
                  notNegative(light.attenuation.z)};
  radius_ = light.radius;
}

Lamp Lamp::along(const Vec& direction, bool asNode) {
  Lamp lamp;
  lamp.isNode_ = asNode;
  lamp.kind_ = Kind::directional;
  lamp.axis_ = direction;
  return lamp;
}

Lamp Lamp::at(const Vec& place) {
  Lamp lamp;
  lamp.isNode_ = false;
  lamp.location_ = place;
  lamp.radius_ = INFINITY;
  return lamp;
}

std::optional<Lamp> Lamp::of(const Node& node, const RenderState& state, bool linear) {
  Lamp lamp;
  bool on = false, global = true;
  if (const auto* parallel = xvrml::nodeCast<xvrml::nodes::DirectionalLight>(&node)) {
    lamp.kind_ = Kind::directional;
    lamp.setLight(*parallel, linear);
    lamp.axis_ = vecOf(parallel->direction);
    on = parallel->on;
    global = parallel->global;
  } else if (const auto* point = xvrml::nodeCast<xvrml::nodes::PointLight>(&node)) {
    lamp.setPlaced(*point, linear);
    on = point->on;
    global = point->global;
  } else if (const auto* spot = xvrml::nodeCast<xvrml::nodes::SpotLight>(&node)) {
    lamp.kind_ = Kind::spot;
    lamp.setPlaced(*spot, linear);
    lamp.axis_ = unit(vecOf(spot->direction));
    lamp.cut_ = spot->cutOffAngle;
    lamp.beam_ = std::min(spot->beamWidth, spot->cutOffAngle);
    on = spot->on;
    global = spot->global;
  } else {
    return {};
  }
  lamp.toWorld_ = affineOf(state.matrix);
  const std::optional<Affine> inverse = lamp.toWorld_.inverse();
  if (!on || !inverse) return {};
  lamp.fromWorld_ = *inverse;
  lamp.scope_ = scopeOf(state, global);
  return lamp;
}

Incident Lamp::incidentAt(const Vec& point) const {
  if (kind_ == Kind::directional) return {unit(toWorld_.vector(axis_)) * -1.0, direct_, ambient_};
  const Vec local = fromWorld_.point(point), toLight = location_ + local * -1.0;
  const double distance = length(toLight);
  double factor = 0;
  if (distance <= radius_)
    factor =
        1 / std::max(attenuation_.x + distance * (attenuation_.y + distance * attenuation_.z), 1.0);
  if (kind_ == Kind::spot) {
    const double angle = std::acos(std::clamp(-dot(unit(toLight), axis_), -1.0, 1.0));
    const double width = cut_ - beam_;
    factor *= width > 0 ? std::clamp((cut_ - angle) / width, 0.0, 1.0) : angle < cut_ ? 1.0 : 0.0;
  }
  return {unit(toWorld_.vector(toLight)), scaled(direct_, factor), scaled(ambient_, factor)};
}

} // namespace picture::raster
