// material_list.h: The materials of a world with their area, and the rules for shaders that they
// get: a part of --explain. [main thread]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libpicture/shader_rules.h"
#include "xvrml/world.h"

namespace vv {

// Shapes that one rule has given its shader, and that have one name, or one colour without a name.
struct MaterialUse {
  std::string name;   // as KiCad or the file calls it; empty: it has no name
  bool byColour;      // the name was found by the colour
  std::string colour; // R,G,B as a selector writes it; empty: the material has none
  std::string rule;   // empty: no rule knows the material
  uint64_t shapes = 0;
  double area = 0; // the triangles as placed, in units of the world
};

// Returns the materials, those with the largest area first. Throws std::length_error for a world
// with too many shapes to place (placedShapes).
std::vector<MaterialUse> materialUses(const std::vector<picture::ShaderRule>& rules,
                                      const xvrml::World& world);

// Returns lines of text for --explain: each material with its share of the area, then how much no
// rule knows.
std::string materialText(const std::vector<MaterialUse>& uses);

} // namespace vv
