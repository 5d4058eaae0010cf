#include "mapper/shading/fogs.h"

#include <map>

#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

template <class T> void setFields(ShaderSetup& shader, const T& fog, const Matrix& world,
                                  const Matrix& local, bool linear, Diagnostics& diagnostics) {
  Matrix toFog;
  if (!(fog.visibilityRange > 0) || !invert(world, toFog)) {
    if (!shader.fresh()) shader.integer("fogType", 0);
    return;
  }
  const bool exponential = fog.fogType == "EXPONENTIAL";
  if (!exponential && fog.fogType != "LINEAR")
    diagnostics.warn(fog.source, fog.type().name + ": fogType \"" + fog.fogType +
                                     "\" is neither LINEAR nor EXPONENTIAL; LINEAR is used");
  shader.integer("fogType", exponential ? 2 : 1);
  shader.color("fogColor", convert(fog.color, linear));
  shader.number("fogRange", fog.visibilityRange);
  shader.matrix("fogMatrix", compose(toFog, local));
}

// Returns whether there is a LocalFog here that may count.
bool isFog(const Graph& graph, const Place& place) {
  const Item& item = graph.items[place.item];
  return item.kind == Kind::localFog && item.on && place.active && place.parent != none;
}

} // namespace

void setFog(ShaderSetup& shader, const Node& fog, const Matrix& world, const Matrix& local,
            bool linear, Diagnostics& diagnostics) {
  if (fog.type().index == nodes::LocalFog::typeIndex)
    setFields(shader, static_cast<const nodes::LocalFog&>(fog), world, local, linear, diagnostics);
  else
    setFields(shader, static_cast<const nodes::Fog&>(fog), world, local, linear, diagnostics);
}

int32_t Fogs::outermost(const Graph& graph, const Places& places) {
  int32_t last = none;
  for (size_t i = 0; i < places.all.size(); ++i)
    if (isFog(graph, places.all[i]) && places.all[i].parent == 0) last = int32_t(i);
  return last;
}

void Fogs::updateForFrame(const Graph& graph, Places& places) {
  std::map<int32_t, int32_t> counting; // by place of a group: that of its LocalFog
  for (size_t i = 0; i < places.all.size(); ++i) {
    Place& place = places.all[i];
    if (!isFog(graph, place) || place.parent == 0) {
      removeFog(place);
      continue;
    }
    const auto [last, fresh] = counting.try_emplace(place.parent, int32_t(i));
    if (fresh) continue;
    removeFog(places.all[size_t(last->second)]);
    last->second = int32_t(i);
  }
  for (const auto& [parent, i] : counting) {
    Place& place = places.all[size_t(i)];
    const RTid group = places.all[places.splitAbove(parent)].instance;
    if (group == 0) { // the group could not be placed
      removeFog(place);
      continue;
    }
    const Node& node = *graph.items[place.item].node;
    makeOrMove(place, node);
    if (place.fog != 0 && group != place.fogScope) rtInstanceFog(place.fogScope = group, place.fog);
    report(world_.diagnostics, node.source, "LocalFog");
  }
  changed_.clear();
}

void Fogs::makeOrMove(Place& place, const Node& node) {
  if (place.fog != 0 && place.fogMatrix == place.world && !changed_.contains(&node)) return;
  const RTid shaderClass = classes_.get("VRML97Environment", "");
  if (place.fog == 0) {
    if (!quota_.take(bytesOfLightShader, node.source)) return;
    ShaderSetup setup(shaderClass);
    place.fog = setup.id();
    setFog(setup, node, place.world, Matrix(), linear_, world_.diagnostics);
  } else {
    ShaderSetup setup(shaderClass, place.fog, sets_);
    setFog(setup, node, place.world, Matrix(), linear_, world_.diagnostics);
  }
  place.fogMatrix = place.world;
}

// The group has no fog of its own any more, because the renderer forgets deleted shaders.
void Fogs::removeFog(Place& place) {
  if (place.fog == 0) return;
  rtDeleteShader(place.fog);
  quota_.give(bytesOfLightShader);
  place.fog = place.fogScope = 0;
}

void Fogs::remove(const std::vector<Place>& gone) {
  for (Place place : gone) removeFog(place);
}

void Fogs::clear(Places& places) {
  for (Place& place : places.all) removeFog(place);
}

} // namespace xvrml::mapper
