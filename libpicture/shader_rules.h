// shader_rules.h: Gives shapes of a loaded world other surface shaders, by rules of the form
// SELECTOR=Class:param=value. Implements --shader, its rules files, the rules of presets, and
// World.set_shader of Python. [the thread that owns the world]
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/shader_text.h"
#include "xvrml/world.h"

namespace picture {

// A rule. Its selector is one of these:
//  - a DEF name of the world's own file: a Shape, an appearance, a Material, or a node above shapes
//  - material:GLOB, appearance:GLOB, shape:GLOB: shapes whose Material, appearance or own node has
//    such a DEF name, also in Inlines and prototypes. * stands for any letters, ? for one.
//  - colour:R,G,B or colour:R,G,B,SHININESS: shapes whose Material has this diffuseColor or
//    baseColor, within 0.03, and this shininess, within 0.0051
//  - *: shapes that have no shader yet
struct ShaderRule {
  std::string text;
  std::string where = "--shader"; // for messages: the option, or the file and line
  std::string folder;             // confines the files that the shader names; empty: anywhere
  bool mayMatchNothing = false;   // no warning if nothing is selected
};

// Returns whether the name matches a pattern with * and ?.
bool matchesGlob(std::string_view pattern, std::string_view name);

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
// how many times a shape got a shader. Throws ShaderError that says what was expected, before the
// rule that it is about has changed anything.
size_t applyShaderRules(const std::vector<ShaderRule>& rules, const std::string& shaderPath,
                        xvrml::World& world, const SetAppearance& set = {});

} // namespace picture
