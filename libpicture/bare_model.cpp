#include "libpicture/bare_model.h"

#include <array>
#include <cmath>
#include <string_view>

#include "libpicture/walk.h"
#include "xvrml/nodes.h"

namespace picture {

namespace {

// display values; dark and light parts can be told from it
constexpr std::array<float, 3> neutral = {0.62f, 0.65f, 0.68f};

bool decidesTheLook(std::string_view type) {
  return type.ends_with("Viewpoint") || type.ends_with("Background") || type.ends_with("Light") ||
         type.ends_with("Camera") || type.ends_with("Fog") || type == "NavigationInfo" ||
         type == "ViewpointGroup" || type == "TextureProjector" || type == "ORTLight" ||
         type == "ORTSensor" || type == "Script";
}

// Returns the filmic curve, with the exposure at which the backdrop keeps its grey: highlights of
// polished parts and white ones are not burnt out then.
ViewTransform curveFor(const std::array<float, 3>& backdrop) {
  const float wanted = linearOf(backdrop[1]);
  double low = 0, high = 4;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    const float radiance[3] = {wanted, wanted, wanted};
    float screen[3];
    toScreen({middle, ViewCurve::filmic}, radiance, screen);
    (screen[1] < wanted ? low : high) = middle;
  }
  return {std::round(low * 64) / 64, ViewCurve::filmic};
}

bool isFromModeller(const xvrml::World& world) {
  return world.head.version.encoding == xvrml::Encoding::gltf;
}

// Modellers write the camera of their window into glTF files. It does not say what is around, nor
// does the shader that glass of such a file gets. isModel: the world is taken for such a file.
Look lookOf(const xvrml::World& world, bool isModel, bool shadersGiven) {
  bool bare = true, metal = false;
  const auto visit = [&](const xvrml::Node& node) {
    const std::string_view type = node.type().name;
    if (isModel && type.ends_with("Viewpoint")) return;
    const bool isShaded = type == "ORTAppearance";
    bare = bare && !decidesTheLook(type) && (shadersGiven || isModel || !isShaded);
    const auto* material =
        xvrml::nodeCast<xvrml::nodes::PhysicalMaterial>(const_cast<xvrml::Node*>(&node));
    metal = metal || isShaded || (material && material->metallic > 0);
  };
  walkInto(world.scope, visit, [](const xvrml::Scope&) {});
  if (!bare) return Look::own;
  return metal || shadersGiven ? Look::studio : Look::backdrop;
}

} // namespace

Look lookOf(const xvrml::World& world, bool shadersGiven) {
  return lookOf(world, isFromModeller(world), shadersGiven);
}

std::string changeOfLook(const xvrml::World& world) {
  if (!isFromModeller(world) || lookOf(world, true, false) == lookOf(world, false, false))
    return {};
  return "outside of glTF a model with a camera or a shader is a world: it is shown before black, "
         "and no longer before the backdrop of vv";
}

bool mayLeaveCameraOut(const xvrml::World& world, const View& view) {
  if (view.viewpoint || view.lookAt || view.fit || view.side || view.viewer || view.pinhole ||
      view.intrinsics || view.shader)
    return false;
  if (!isFromModeller(world) || lookOf(world, true) == Look::own) return false;
  size_t cameras = 0;
  const auto count = [&](const xvrml::Node& node) {
    cameras += node.type().name.ends_with("Viewpoint") ? 1 : 0;
  };
  const auto enter = [](const xvrml::Scope&) {};
  walkInto(world.scope, count, enter);
  if (cameras != 1) return false;
  cameras = 0; // below a node that an animation moves
  for (const xvrml::Route& route : world.scope.routes)
    walkInto(NodeList{route.to.get()}, count, enter);
  return cameras == 0;
}

bool leavesLookOpen(const RenderSettings& settings) {
  return settings.background.kind == Background::Kind::world && !settings.hasSurroundings() &&
         !settings.studio.on;
}

void choose(Look look, RenderSettings& settings) {
  if (look == Look::own) return;
  if (look == Look::studio && settings.linear) {
    settings.studio = {true, neutral};
    if (settings.view.isPlain()) settings.view = curveFor(neutral);
  } else {
    settings.background.kind = Background::Kind::backdrop;
    settings.background.colour = neutral;
  }
}

} // namespace picture
