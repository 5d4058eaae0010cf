#include "libpicture/kicad_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "libpicture/walk.h"
#include "srgb.h"
#include "xvrml/appearance.h"

namespace picture {

namespace {

using namespace xvrml;

// The colours of the materials that the parts of KiCad 5 to 9 name, by their names. Parts in STEP
// have the same colours and no names.
struct PaletteEntry {
  std::string_view name;
  Color colour;
  bool isClear; // it has a transparency
};
constexpr PaletteEntry palette[] = {
    {"BOARD-BLACK-03", {.16f, .16f, .16f}, false},
    {"BOARD-BLUE-01", {.07f, .12f, .3f}, false},
    {"BOARD-GREEN-02", {.07f, .3f, .12f}, false},
    {"CAP-CERAMIC-02", {.578f, .336f, .352f}, false},
    {"CAP-CERAMIC-05", {.273f, .273f, .273f}, false},
    {"CAP-CERAMIC-06", {.379f, .27f, .215f}, false},
    {"GLASS-13", {0, .631f, .748f}, true},
    {"GLASS-19", {.401f, .442f, .459f}, true},
    {"GLASS-29", {.567f, .581f, .581f}, true},
    {"GLASS-29", {.859f, .738f, .496f}, true},
    {"GLASS-GREEN", {0, .75f, .44f}, true},
    {"GLASS-ORANGE", {.75f, .44f, 0}, true},
    {"IC-BODY-EPOXY-01", {.25f, .262f, .281f}, false},
    {"IC-BODY-EPOXY-04", {.148f, .145f, .145f}, false},
    {"IC-LABEL-01", {.691f, .664f, .598f}, false},
    {"LED-BLACK", {.1f, .05f, .1f}, true},
    {"LED-BLUE", {.1f, .25f, .7f}, true},
    {"LED-GREEN", {.4f, .7f, .15f}, true},
    {"LED-GREY", {.27f, .25f, .27f}, true},
    {"LED-RED", {.7f, .1f, .05f}, true},
    {"LED-WHITE", {.895f, .891f, .813f}, true},
    {"LED-YELLOW", {.98f, .84f, .066f}, true},
    {"MET-01", {.298f, .298f, .298f}, false},
    {"MET-ALUMINUM", {.372f, .372f, .373f}, false},
    {"MET-BRONZE", {.714f, .428f, .181f}, false},
    {"MET-COPPER", {.704f, .27f, .083f}, false},
    {"MET-SILVER", {.5075f, .5075f, .5075f}, false},
    {"PIN-01", {.824f, .82f, .781f}, false},
    {"PIN-02", {.859f, .738f, .496f}, false},
    {"PLASTIC-BLUE-01", {.137f, .402f, .727f}, false},
    {"PLASTIC-GREEN-01", {.34f, .68f, .445f}, false},
    {"PLASTIC-GREEN-27", {.136f, .191f, .122f}, false},
    {"PLASTIC-ORANGE-01", {.809f, .426f, .148f}, false},
    {"PLASTIC-WHITE-01", {.895f, .891f, .813f}, false},
    {"PLASTIC-YELLOW-01", {.832f, .68f, .066f}, false},
    {"RED-BODY", {.7f, .1f, .05f}, false},
    {"RES-SMD-01", {.082f, .086f, .094f}, false},
    {"RES-THT-01", {.883f, .711f, .492f}, false},
};
// A name that begins so is KiCad's, whatever its number.
constexpr std::string_view families[] = {"BOARD-", "CAP-", "GLASS-",   "IC-",      "LED-",
                                         "MET-",   "PIN-", "PLASTIC-", "RED-BODY", "RES-"};

// The layers of a board in a file of glTF: the end of the name of their meshes (KiCad 8 to 10), and
// the name of their material.
struct Layer {
  std::string_view mesh, material, name;
};
constexpr Layer layers[] = {
    {"_copper", "copper", "layer-copper"},
    {"_pad", "pad", "layer-pad"},
    {"_via", "copper", "layer-copper"},
    {"_soldermask", "soldermask", "layer-soldermask"},
    {"_silkscreen", "silkscreen", "layer-silkscreen"},
    {"_PCB", "board", "layer-board"},
};

Color decoded(const Color& c) { return {decodeSrgb(c.r), decodeSrgb(c.g), decodeSrgb(c.b)}; }
Color encoded(const Color& c) { return {encodeSrgb(c.r), encodeSrgb(c.g), encodeSrgb(c.b)}; }

float distance(const Color& a, const Color& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

// Returns a name without the number that makes it unique in its file: x_2 for a second x.
std::string_view withoutNumber(std::string_view name) {
  const size_t digits = name.find_last_not_of("0123456789");
  const bool isNumbered = digits != name.npos && digits + 1 < name.size() && name[digits] == '_';
  return isNumbered ? name.substr(0, digits) : name;
}

// Returns the name of a layer for the mesh or material of a file of glTF; empty if it is none.
std::string_view layerOf(const std::string& defName, bool isMaterial) {
  const std::string_view name = withoutNumber(defName);
  for (const Layer& layer : layers)
    if (isMaterial ? name == layer.material : name.ends_with(layer.mesh)) return layer.name;
  return {};
}

bool isInGltf(const Node& node) {
  if (!node.source.file) return false;
  return node.source.file->ends_with(".glb") || node.source.file->ends_with(".gltf");
}

bool isKicadName(std::string_view name) {
  return std::any_of(std::begin(families), std::end(families),
                     [&](std::string_view family) { return name.starts_with(family); });
}

// Returns whether a node stands in the file of an LED. KiCad names the models of LEDs so.
bool isPartOfLed(const Node& node) {
  return node.source.file &&
         std::filesystem::path(*node.source.file).filename().string().starts_with("LED");
}

} // namespace

KicadMaterial kicadMaterialOf(const Color& colour, float transparency) {
  const std::pair<Color, bool> forms[] = {
      {colour, true}, {encoded(colour), false}, {decoded(colour), false}};
  // One that is clear as the shape is comes first, then the nearest.
  std::pair<bool, float> nearest{true, kicadColourTolerance};
  KicadMaterial found;
  for (const PaletteEntry& entry : palette)
    for (const auto& [form, isOwn] : forms) {
      const float away = distance(form, entry.colour);
      const std::pair<bool, float> key{entry.isClear != (transparency > 0), away};
      if (away > kicadColourTolerance || key > nearest) continue;
      nearest = key;
      found = {std::string(entry.name), true, isOwn ? std::nullopt : std::optional(entry.colour)};
    }
  return found;
}

KicadMaterials::KicadMaterials(const World& world) {
  std::vector<std::pair<const Node*, std::string_view>> meshes;
  const auto find = [&](const Node& node) {
    if (!isInGltf(node)) return;
    if (const std::string_view name = layerOf(node.defName, false); !name.empty())
      meshes.emplace_back(&node, name);
  };
  walkInto(world.scope, find, [](const Scope&) {});
  for (const auto& [mesh, name] : meshes) {
    const auto add = [&, layer = name](const Node& node) {
      if (nodeCast<nodes::Shape>(&node)) layers_.emplace(&node, layer);
    };
    walkInto(NodeList{mesh}, add, [](const Scope&) {});
  }
}

KicadMaterial KicadMaterials::of(const nodes::Shape& shape) const {
  const AppearanceParts parts = resolveAppearance(shape.appearance.get());
  if (!parts.appearance) return {};
  for (const Node* node : {parts.material, parts.appearance})
    if (node && isKicadName(node->defName)) return {node->defName, false, {}};
  const MaterialValues values = materialValues(parts.material);
  using Model = MaterialValues::Model;
  if (values.model != Model::phong && values.model != Model::physical) return {};
  std::string_view layer;
  if (isInGltf(shape)) layer = layerOf(parts.appearance->defName, true);
  if (const auto below = layers_.find(&shape); below != layers_.end()) layer = below->second;
  // KiCad writes the colours of layers, which are sRGB, as the linear numbers of glTF. A shape that
  // a rule has given a shader has the right colour.
  if (!layer.empty())
    return {std::string(layer), false,
            parts.shader ? std::nullopt : std::optional(decoded(values.color))};
  KicadMaterial found = kicadMaterialOf(values.color, values.transparency);
  if (found.name == "RED-BODY" && isPartOfLed(shape)) found.name = "LED-RED";
  return found;
}

} // namespace picture
