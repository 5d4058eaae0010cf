#include "bare_model.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "libpicture/walk.h"

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

} // namespace

bool isBareModel(const xvrml::World& world) {
  bool bare = true;
  const auto visit = [&](const xvrml::Node& node) {
    bare = bare && !decidesTheLook(node.type().name);
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
  options.render.background.kind = picture::Background::Kind::colour;
  options.render.background.colour = neutral;
}

} // namespace vv
