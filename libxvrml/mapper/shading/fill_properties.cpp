// fill_properties.cpp: the shader draws the lines (plugins/shaders/hatch.h).
#include "mapper/shading/fill_properties.h"

#include <string>

namespace xvrml::mapper {
namespace {

constexpr int32_t styles = 19; // those of the register of graphical items (ISO/IEC 9973)

const nodes::FillProperties* fillOf(const nodes::Appearance* appearance) {
  if (!appearance) return nullptr;
  return nodeCast<nodes::FillProperties>(renderedNode(appearance->fillProperties.get()));
}

bool isKnown(int32_t style) { return style >= 1 && style <= styles; }

} // namespace

bool isUnfilled(const nodes::Appearance* appearance) {
  const auto* fill = fillOf(appearance);
  return fill && !fill->filled;
}

bool isHatched(const nodes::Appearance* appearance) {
  const auto* fill = fillOf(appearance);
  return fill && fill->hatched;
}

void setHatching(ShaderSetup& shader, const nodes::Appearance* appearance, bool linear) {
  if (!isHatched(appearance)) return shader.integer("hatchStyle", 0);
  const auto* fill = fillOf(appearance);
  shader.integer("hatchStyle", isKnown(fill->hatchStyle) ? fill->hatchStyle : 1);
  shader.color("hatchColor", convert(fill->hatchColor, linear));
}

void warnOfHatching(const nodes::Appearance* appearance, World& world) {
  if (const auto* fill = fillOf(appearance); fill && fill->hatched && !isKnown(fill->hatchStyle))
    world.diagnostics.warn(fill->source, "FillProperties: hatchStyle is " +
                                             std::to_string(fill->hatchStyle) +
                                             ", expected 1 to 19: it is drawn as 1");
}

} // namespace xvrml::mapper
