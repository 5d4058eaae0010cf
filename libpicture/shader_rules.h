// shader_rules.h: Gives shapes of a loaded world other surface shaders, by rules of the form
// SELECTOR=Class:param=value. Implements --shader, its rules files, the rules of presets, and
// World.set_shader of Python. [the thread that owns the world]
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/kicad_materials.h"
#include "libpicture/shader_text.h"
#include "xvrml/world.h"

namespace picture {

// A rule. Its selector is one of these:
//  - a DEF name of the world's own file: a Shape, an appearance, a Material, or a node above shapes
//  - material:GLOB, appearance:GLOB, shape:GLOB: shapes whose Material, appearance or own node has
//    such a DEF name, also in Inlines and prototypes. * stands for any letters, ? for one.
//  - kicad:GLOB: shapes of a material of KiCad's libraries (PIN-01) or a layer of its boards
//    (layer-copper), by a name in the file, else by the colour (kicad_materials.h)
//  - colour:R,G,B or colour:R,G,B,SHININESS: shapes whose Material has this diffuseColor or
//    baseColor, within 0.03, and this shininess, within 0.0051
//  - *: shapes that have no shader yet
struct ShaderRule {
  std::string text;
  std::string where = "--shader"; // for messages: the option, or the file and line
  std::string folder;             // confines the files that the shader names; empty: anywhere
  bool mayMatchNothing = false;   // no warning if nothing is selected
};

// Reads a file of rules, one a line; empty lines and lines that begin with # say nothing. Throws
// std::runtime_error that names the file and the line, if there is one.
std::vector<ShaderRule> readShaderRules(const std::string& path);

// Throws ShaderError unless the text has the form of a rule.
void checkShaderRule(const std::string& text);

// Assigns an appearance to a Shape.
using SetAppearance = std::function<void(xvrml::Node& shape, const xvrml::NodeRef& appearance)>;

// Applies the rules in their order, those for * last. Later ones win. Material and texture of a
// shape stay, for shaders that have such parameters. A pattern or colour that selects nothing is a
// warning of the world, and so is a rule for * that makes shapes of several colours alike. Returns
// how many shapes got a shader. Throws ShaderError that says what was expected, before the rule
// that it is about has changed anything.
size_t applyShaderRules(const std::vector<ShaderRule>& rules, const std::string& shaderPath,
                        xvrml::World& world, const SetAppearance& set = {});

// A shape, and the rule that it gets its shader from.
struct ShapeRule {
  const xvrml::nodes::Shape* shape = nullptr;
  KicadMaterial kicad;              // only if a rule selects by it
  const ShaderRule* rule = nullptr; // null: none, but perhaps one for *
};

// Returns the shapes of a world that rules may have been applied to. Pointers are to the rules that
// are given. Throws ShaderError as applyShaderRules does.
std::vector<ShapeRule> rulesOfShapes(const std::vector<ShaderRule>& rules,
                                     const xvrml::World& world);

} // namespace picture
