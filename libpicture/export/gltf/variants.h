// variants.h: Switches that choose between looks of one geometry, as KHR_materials_variants. [the
// thread that owns the world]
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "libpicture/export/gltf/document.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace picture::gltf {

// The look of a choice of a Switch. name: the DEF name of the Appearance, the material or the
// Shape, with a number where two looks of a Switch have one name; else a number.
struct Look {
  std::string name;
  xvrml::AppearanceParts parts;
};
// Returns the looks that a Switch chooses between. Empty, unless its choices are two or more Shapes
// of one geometry node.
std::vector<Look> looksOf(const xvrml::nodes::Switch& node);

// The variants of a document. Those of one name are one variant, so that it changes all parts.
class Variants {
 public:
  // Returns the index of a variant.
  size_t of(const std::string& name);
  // Writes the list, if there are variants. Call it after the meshes.
  void write(Document& document) const;

 private:
  std::unordered_map<std::string, size_t> indices_;
  std::vector<std::string> names_;
};

} // namespace picture::gltf
