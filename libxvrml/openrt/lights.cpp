// lights.cpp: see lights.h. Clauses 4.6.6 (lights and their scope), 6.14, 6.34 and 6.44.
#include "openrt/lights.h"

#include <algorithm>

#include "xvrml/nodes.h"

namespace xvrml::mapping {
namespace {
Vec3f notNegative(Vec3f v) { return {std::max(v.x, 0.0f), std::max(v.y, 0.0f), std::max(v.z, 0.0f)}; }
} // namespace

RTid Lights::makeShader(Node& node) {
  if (auto* d = nodeCast<nodes::DirectionalLight>(&node)) {
    ShaderSetup s(classes_.get("VRML97DirectionalLight", ""));
    s.color("color", convert(d->color, linear_));
    s.number("intensity", d->intensity, 0);
    s.number("ambientIntensity", d->ambientIntensity, 0);
    s.vector("direction", d->direction);
    return s.id();
  }
  if (auto* p = nodeCast<nodes::PointLight>(&node)) {
    ShaderSetup s(classes_.get("VRML97PointLight", ""));
    s.color("color", convert(p->color, linear_));
    s.number("intensity", p->intensity, 0);
    s.number("ambientIntensity", p->ambientIntensity, 0);
    s.vector("location", p->location);
    s.vector("attenuation", notNegative(p->attenuation));
    s.number("radius", p->radius, 0);
    return s.id();
  }
  auto& spot = static_cast<nodes::SpotLight&>(node);
  ShaderSetup s(classes_.get("VRML97SpotLight", ""));
  s.color("color", convert(spot.color, linear_));
  s.number("intensity", spot.intensity, 0);
  s.number("ambientIntensity", spot.ambientIntensity, 0);
  s.vector("location", spot.location);
  s.vector("direction", spot.direction);
  s.vector("attenuation", notNegative(spot.attenuation));
  s.number("radius", spot.radius, 0);
  s.number("beamWidth", spot.beamWidth, 0, 3.1415927f);
  s.number("cutOffAngle", spot.cutOffAngle, 0, 3.1415927f);
  return s.id();
}

RTid Lights::shaderOf(Node& light) {
  const auto [it, fresh] = shaders_.try_emplace(&light, 0);
  if (fresh) {
    it->second = makeShader(light);
    report(world_.diagnostics, light.source, light.type().name);
  }
  return it->second;
}

void Lights::follow(const Graph& graph, Places& places) {
  count_ = 0;
  for (Place& place : places.all) {
    const Item& item = graph.items[place.item];
    if (!isLight(item.kind)) continue;
    if (!place.active || !finite(place.world)) {
      if (place.light != 0) rtRemoveLight(place.light);
      place.light = 0;
      continue;
    }
    ++count_;
    load(place.world);
    if (place.light == 0)
      place.light = rtUseLight(shaderOf(*item.node));
    else
      rtLightMatrix(place.light, data(place.world));
    // A DirectionalLight shines on the descendants of its parent group only. The group's object holds nothing else: see
    // Places. At the top level of the file that is everything.
    if (item.kind == Kind::directionalLight && place.light != 0 && place.parent != 0) {
      const RTid scope = places.all[places.splitAbove(place.parent)].instance;
      if (scope != 0) {
        rtLightScope(place.light, scope);
      } else { // the group itself could not be placed: nothing is there to shine on
        rtRemoveLight(place.light);
        place.light = 0;
      }
    }
    report(world_.diagnostics, item.node->source, item.node->type().name);
  }
}

void Lights::remove(Places& places) {
  for (Place& place : places.all)
    if (place.light != 0) rtRemoveLight(place.light);
  if (headlight_ != 0) rtRemoveLight(headlight_);
}

void Lights::headlight(bool on, const CameraSettings& camera) {
  if (!on) {
    if (headlight_ != 0) rtRemoveLight(headlight_);
    headlight_ = 0;
    return;
  }
  ++count_;
  const Matrix view = rigid(fromArray(camera.matrix));
  if (headlight_ != 0) return rtLightMatrix(headlight_, data(view));
  RTid shader;
  {
    ShaderSetup s(classes_.get("VRML97DirectionalLight", ""));
    s.vector("direction", {0, 0, -1});
    s.integer("shadows", 0);
    shader = s.id();
  }
  load(view);
  headlight_ = rtUseLight(shader);
  report(world_.diagnostics, {}, "headlight");
}

} // namespace xvrml::mapping
