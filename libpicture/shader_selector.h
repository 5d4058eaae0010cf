// shader_selector.h: Reads the selectors of shader rules (shader_rules.h says which there are), and
// tells which rule a shape gets its shader from. [the thread that owns the world]
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/kicad_materials.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace picture {

// Says what a rule selects.
struct Selector {
  enum class Kind : uint8_t { rest, name, material, appearance, shape, kicad, colour };
  Kind kind = Kind::rest;
  std::string pattern;
  std::vector<float> colour;            // red, green, blue, and the shininess if it counts
  std::set<const xvrml::Node*> below{}; // a name selects its node and all nodes below
};

// Returns a text without the blanks at its ends.
std::string trimmed(std::string_view text);

// Returns whether the name matches a pattern with * and ?.
bool matchesGlob(std::string_view pattern, std::string_view name);

// Reads a selector. Throws ShaderError that says what was expected.
Selector readSelector(const std::string& text);
// Fills `below` of a selector. Throws ShaderError if the world's own file has no such name.
void findNamed(Selector& selector, const xvrml::World& world);

// The nodes of an appearance, as written in the file.
struct WrittenParts {
  xvrml::NodeRef material, texture, textureTransform, shader;
};
WrittenParts writtenParts(xvrml::Node* appearance);

// A shape, and how the rules see it.
struct SelectedShape {
  static constexpr size_t none = size_t(-1);
  xvrml::nodes::Shape* shape = nullptr;
  KicadMaterial kicad;    // only if a rule asks for it
  bool hasShader = false; // already in the file
  size_t rule = none;     // the last rule but those for * that selects it
};

// Returns the shapes of a world, prototypes and Inlines included, in the order of a walk. `counts`
// tells for each selector how many shapes it selects; 0 for those of *.
std::vector<SelectedShape> selectShapes(const std::vector<Selector>& selectors,
                                        const xvrml::World& world, std::vector<size_t>& counts);

} // namespace picture
