// kicad_materials.h: Finds out what KiCad calls the material of a shape: for the selector
// kicad:GLOB of rules (shader_rules.h) and for --explain. Decision 97 says why. [the thread that
// owns the world]
#pragma once

#include <optional>
#include <string>
#include <unordered_map>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace picture {

// A material of KiCad's part library ("PIN-01"), or a layer of a board ("layer-soldermask").
struct KicadMaterial {
  std::string name;                   // empty: KiCad has no such material
  bool byColour = false;              // the file gives the material no name that is KiCad's
  std::optional<xvrml::Color> colour; // the file has KiCad's colour in another form than Materials
};

// Returns the material of the palette with this colour and transparency; none if there is none
// within `kicadColourTolerance`. The colour may be KiCad's numbers, their linear form, or KiCad's
// numbers taken for linear ones and encoded.
inline constexpr float kicadColourTolerance = 0.005f;
KicadMaterial kicadMaterialOf(const xvrml::Color& colour, float transparency);

class KicadMaterials {
 public:
  // Looks for the layers of boards in the world, which files of glTF name above their shapes.
  explicit KicadMaterials(const xvrml::World& world);

  // Returns KiCad's name for the material of a shape. A name of KiCad's in the file wins over the
  // colour.
  KicadMaterial of(const xvrml::nodes::Shape& shape) const;

 private:
  std::unordered_map<const xvrml::Node*, std::string> layers_; // by shape
};

} // namespace picture
