// lights.cpp: creates lights and sets their scope (clauses 4.6.6, 6.16, 6.35 and 6.45).
#include "mapper/shading/lights.h"

#include <algorithm>
#include <span>

#include "mapper/model.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {
Vec3f notNegative(Vec3f v) {
  return {std::max(v.x, 0.0f), std::max(v.y, 0.0f), std::max(v.z, 0.0f)};
}

void set(ShaderSetup& s, const nodes::DirectionalLight& light, bool linear) {
  s.color("color", convert(light.color, linear));
  s.number("intensity", light.intensity, 0);
  s.number("ambientIntensity", light.ambientIntensity, 0);
  s.vector("direction", light.direction);
}

template <class PlacedLight> void setPlaced(ShaderSetup& s, const PlacedLight& light, bool linear) {
  s.color("color", convert(light.color, linear));
  s.number("intensity", light.intensity, 0);
  s.number("ambientIntensity", light.ambientIntensity, 0);
  s.vector("location", light.location);
  s.vector("attenuation", notNegative(light.attenuation));
  s.number("radius", light.radius, 0);
}

void set(ShaderSetup& s, const Node& node, bool linear) {
  if (node.type().index == nodes::DirectionalLight::typeIndex)
    return set(s, static_cast<const nodes::DirectionalLight&>(node), linear);
  if (node.type().index == nodes::PointLight::typeIndex)
    return setPlaced(s, static_cast<const nodes::PointLight&>(node), linear);
  auto& spot = static_cast<const nodes::SpotLight&>(node);
  setPlaced(s, spot, linear);
  s.vector("direction", spot.direction);
  s.number("beamWidth", spot.beamWidth, 0, 3.1415927f);
  s.number("cutOffAngle", spot.cutOffAngle, 0, 3.1415927f);
}

bool isCustom(const Node& light) { return light.type().index == nodes::ORTLight::typeIndex; }

const char* classOf(const Node& light) {
  if (light.type().index == nodes::DirectionalLight::typeIndex) return "VRML97DirectionalLight";
  return light.type().index == nodes::PointLight::typeIndex ? "VRML97PointLight"
                                                            : "VRML97SpotLight";
}
} // namespace

RTid Lights::shaderOf(Node& light) {
  const auto [it, fresh] = shaders_.try_emplace(&light);
  if (fresh && isCustom(light)) {
    auto* shader =
        nodeCast<nodes::ORTShader>(renderedNode(static_cast<nodes::ORTLight&>(light).shader.get()));
    it->second = {shader ? custom_.shaderFor(*shader, RT_LIGHT) : 0, false};
  } else if (fresh) {
    if (!quota_.take(bytesOfLightShader, light.source)) {
      shaders_.erase(it);
      return 0;
    }
    ShaderSetup setup(classes_.get(classOf(light), ""));
    set(setup, light, linear_);
    it->second = {setup.id(), true};
    report(world_.diagnostics, light.source, light.type().name);
  }
  return it->second.shader;
}

void Lights::changed(Node& light) {
  const auto found = shaders_.find(&light);
  if (found == shaders_.end()) return; // the light is read when it is turned on
  if (isCustom(light)) {
    const RTid before = found->second.shader;
    shaders_.erase(found);
    if (shaderOf(light) != before) remade_.insert(&light);
    return;
  }
  ShaderSetup setup(classes_.get(classOf(light), ""), found->second.shader, sets_);
  set(setup, light, linear_);
  report(world_.diagnostics, light.source, light.type().name);
}

void Lights::removeLight(RTid& light, uint64_t bytes) {
  if (light == 0) return;
  rtRemoveLight(light);
  light = 0;
  quota_.give(bytes);
  ++changes_;
}

void Lights::remove(const std::vector<Place>& gone) {
  for (Place place : gone) removeLight(place.light);
}

void Lights::clear(Places& places) {
  for (Place& place : places.all) removeLight(place.light);
  removeCameraLights();
  for (const auto& [node, known] : shaders_)
    if (known.own) rtDeleteShader(known.shader);
  if (headlight_.shader != 0) rtDeleteShader(headlight_.shader);
  for (const CameraAttachedLight& one : modelLights_)
    if (one.shader != 0) rtDeleteShader(one.shader);
}

void Lights::forget(const Graph& graph) {
  std::erase_if(shaders_, [&](const auto& known) {
    if (graph.find(known.first) != 0) return false;
    if (known.second.own) {
      rtDeleteShader(known.second.shader);
      quota_.give(bytesOfLightShader);
    }
    return true;
  });
}

// Creates, moves and removes lights. Lights are summed in the order of their creation, which must
// be the order of the places, whatever existed before. So all lights after a new one are created
// again.
void Lights::updateForFrame(const Graph& graph, Places& places) {
  count_ = 0;
  bool behindNew = false;
  for (Place& place : places.all) {
    const Item& item = graph.items[place.item];
    if (!isLight(item.kind) || item.kind == Kind::environmentLight) continue;
    if (!place.active || !item.on || !finite(place.world)) {
      removeLight(place.light);
      continue;
    }
    ++count_;
    if (behindNew || remade_.contains(item.node.get())) removeLight(place.light);
    behindNew |= place.light == 0;
    makeOrMove(place, item);
    if (place.light != 0) scope(place, item, places);
  }
  remade_.clear();
  if (behindNew) removeCameraLights();
}

void Lights::makeOrMove(Place& place, const Item& item) {
  if (place.light != 0 && place.lightMatrix == place.world) return;
  if (place.light == 0) {
    const bool allowed = quota_.take(bytesOfLight, item.node->source);
    // A light beyond the budget gets no shader either.
    const RTid shader = allowed ? shaderOf(*item.node) : 0;
    if (shader == 0) {
      if (allowed) quota_.give(bytesOfLight);
      --count_;
      return;
    }
    load(place.world);
    place.light = rtUseLight(shader);
    if (place.light == 0) quota_.give(bytesOfLight);
    place.lightScope = 0;
  } else {
    rtLightMatrix(place.light, data(place.world));
  }
  place.lightMatrix = place.world;
  ++changes_;
  report(world_.diagnostics, item.node->source, item.node->type().name);
}

// A scoped light illuminates only the descendants of its parent group, and other lights of an
// Inline may illuminate only what that Inline holds. The group has an object of its own for this
// (see Places). At the top level of the file the scope of a light is the whole world.
void Lights::scope(Place& place, const Item& item, const Places& places) {
  const int32_t group = item.scoped ? place.parent : place.limit;
  RTid scope = 0;
  if (group != none && group != 0) {
    scope = places.all[places.splitAbove(group)].instance;
    if (scope == 0)
      return removeLight(
          place.light); // the group could not be placed, so there is nothing to illuminate
  }
  if (scope == place.lightScope) return;
  rtLightScope(place.light, scope);
  place.lightScope = scope;
  ++changes_;
}

void Lights::removeCameraLights() {
  removeLight(headlight_.light, 0);
  for (CameraAttachedLight& one : modelLights_) removeLight(one.light, 0);
}

void Lights::atCamera(CameraLight light, const CameraSettings& camera) {
  static constexpr Lamp headlamp[] = {{{0, 0, -1}, 1}};
  if (light != atCamera_) removeCameraLights();
  atCamera_ = light;
  if (light == CameraLight::none) return;
  const bool head = light == CameraLight::head;
  const std::span<const Lamp> lamps =
      head ? std::span<const Lamp>(headlamp) : std::span<const Lamp>(modelLamps);
  const std::span<CameraAttachedLight> used = head ? std::span<CameraAttachedLight>(&headlight_, 1)
                                                   : std::span<CameraAttachedLight>(modelLights_);
  const Matrix view = rigid(fromArray(camera.matrix));
  for (size_t i = 0; i < used.size(); ++i) {
    CameraAttachedLight& one = used[i];
    ++count_;
    if (one.light != 0) {
      if (view != view_) rtLightMatrix(one.light, data(view));
      continue;
    }
    if (one.shader == 0) {
      ShaderSetup s(classes_.get("VRML97DirectionalLight", ""));
      s.vector("direction", lamps[i].direction);
      if (lamps[i].intensity != 1) s.number("intensity", lamps[i].intensity, 0);
      s.integer("shadows", 0);
      if (!head) s.integer("irradiance", 0); // as bright on all materials
      one.shader = s.id();
    }
    load(view);
    one.light = rtUseLight(one.shader);
    ++changes_;
  }
  view_ = view;
  report(world_.diagnostics, {}, "headlight");
}

} // namespace xvrml::mapper
