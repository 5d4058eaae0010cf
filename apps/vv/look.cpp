#include "bare_model.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "libpicture/walk.h"
#include "xvrml/nodes.h"

namespace vv {

namespace {

// display values; dark and light parts can be told from it
constexpr std::array<float, 3> neutral = {0.62f, 0.65f, 0.68f};

bool decidesTheLook(std::string_view type) {
  return type.ends_with("Viewpoint") || type.ends_with("Background") || type.ends_with("Light") ||
         type.ends_with("Camera") || type.ends_with("Fog") || type == "NavigationInfo" ||
         type == "ViewpointGroup" || type == "TextureProjector" || type == "ORTAppearance" ||
         type == "ORTLight" || type == "ORTSensor" || type == "Script";
}

// Returns whether a part is metal, which shows what is around it and little else.
bool hasMetal(const xvrml::World& world) {
  bool metal = false;
  const auto visit = [&](const xvrml::Node& node) {
    const auto* material =
        xvrml::nodeCast<xvrml::nodes::PhysicalMaterial>(const_cast<xvrml::Node*>(&node));
    metal = metal || (material && material->metallic > 0);
  };
  picture::walkInto(world.scope, visit, [](const xvrml::Scope&) {});
  return metal;
}

} // namespace

bool isBareModel(const xvrml::World& world) {
  // Modellers write the camera of their window into glTF files. It does not say what is around.
  const bool camerasSayNothing = world.head.version.encoding == xvrml::Encoding::gltf;
  bool bare = true;
  const auto visit = [&](const xvrml::Node& node) {
    const std::string_view type = node.type().name;
    bare = bare && (!decidesTheLook(type) || (camerasSayNothing && type.ends_with("Viewpoint")));
  };
  picture::walkInto(world.scope, visit, [](const xvrml::Scope&) {});
  return bare;
}

void chooseBackground(Options& options, const xvrml::World& world) {
  const picture::RenderSettings& render = options.render;
  const bool open = render.background.kind == picture::Background::Kind::world &&
                    render.environment.empty() && !render.studio.on && options.compare.empty() &&
                    !options.audit && !options.falseColour && options.shaders.empty() &&
                    render.headlight == xvrml::MapOptions::Headlight::automatic &&
                    render.channels == RT_RGBA && !options.outputs.empty();
  const bool forScreens =
      std::all_of(options.outputs.begin(), options.outputs.end(), [](const Output& output) {
        return output.film != picture::FilmKind::none ||
               (output.format->appliesCurve && output.format->name != "PPM");
      });
  if (!open || !forScreens || !isBareModel(world)) return;
  if (hasMetal(world) && render.linear && !options.measures()) {
    options.render.studio = {true, neutral};
    return;
  }
  options.render.background.kind = picture::Background::Kind::colour;
  options.render.background.colour = neutral;
}

} // namespace vv
