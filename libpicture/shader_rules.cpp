#include "libpicture/shader_rules.h"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "file_contents.h"
#include "libpicture/shader_selector.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace picture {

namespace {

using namespace xvrml;

constexpr size_t rulesFileBytes = 1 << 20; // a longer file is refused
constexpr std::string_view byteOrderMark = "\xef\xbb\xbf";

// Splits a rule into its selector and the text of its shader.
std::pair<Selector, std::string> readRule(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == text.npos || trimmed(text.substr(0, equals)).empty())
    throw ShaderError(
        fmt::format("SELECTOR=CLASS[:PARAM=VALUE...] was expected, not \"{}\"", text));
  return {readSelector(trimmed(text.substr(0, equals))), trimmed(text.substr(equals + 1))};
}

// Returns the number of different colours that the lit materials of shapes have.
size_t countColours(const std::vector<const SelectedShape*>& shapes) {
  std::set<std::array<float, 3>> colours;
  for (const SelectedShape* one : shapes) {
    const WrittenParts parts = writtenParts(renderedNode(one->shape->appearance.get()));
    const MaterialValues values = materialValues(parts.material.get());
    using Model = MaterialValues::Model;
    if (values.model == Model::phong || values.model == Model::physical)
      colours.insert({values.color.r, values.color.g, values.color.b});
  }
  return colours.size();
}

NodeRef makeNode(const char* typeName) {
  const NodeType& type = *findNodeType(typeName);
  return NodeRef(type.create(type));
}

// Returns the material for a shape: that of the file, or one with KiCad's own colour.
NodeRef materialOf(const SelectedShape& one, const NodeRef& written) {
  if (!one.kicad.colour) return written;
  const MaterialValues values = materialValues(written.get());
  NodeRef made = makeNode("Material");
  auto& material = static_cast<nodes::Material&>(*made);
  material.diffuseColor = *one.kicad.colour;
  material.specularColor = values.specularColor;
  material.shininess = values.shininess;
  material.transparency = values.transparency;
  material.defName = written->defName;
  material.source = written->source;
  return made;
}

// Gives shapes an appearance with this shader. addMaterial: one without a material gets a Material,
// so that its colour is not the shader's default.
void give(const std::vector<const SelectedShape*>& shapes, const NodeRef& shader, bool addMaterial,
          World& world, const SetAppearance& set) {
  std::map<const Node*, NodeRef> made; // keeps shared appearances shared
  for (const SelectedShape* one : shapes) {
    Node* before = renderedNode(one->shape->appearance.get());
    NodeRef& appearance = made[before];
    if (!appearance) {
      appearance = makeNode("ORTAppearance");
      auto& own = static_cast<nodes::ORTAppearance&>(*appearance);
      const WrittenParts parts = writtenParts(before);
      own.material = parts.material ? materialOf(*one, parts.material)
                     : addMaterial  ? makeNode("Material")
                                    : NodeRef();
      own.texture = parts.texture;
      own.textureTransform = parts.textureTransform;
      own.shader = shader;
      own.source = shader->source;
      if (before) own.defName = before->defName;
      for (auto& [name, node] : world.scope.names)
        if (before && node.get() == before) node = appearance;
    }
    if (set)
      set(*one->shape, appearance);
    else
      one->shape->appearance = appearance;
  }
}

// A rule that has been read. Those for * come last; only the last one of them counts.
struct ReadRule {
  const ShaderRule* written = nullptr;
  Selector selector;
  std::string shader;

  ShaderError wrong(const std::string& why) const {
    return ShaderError(fmt::format("{} {}: {}", written->where, written->text, why));
  }
};

std::vector<ReadRule> readRules(const std::vector<ShaderRule>& written, const World& world) {
  std::vector<ReadRule> rules;
  std::optional<ReadRule> rest;
  for (const ShaderRule& rule : written) {
    ReadRule read{&rule, {}, {}};
    try {
      std::tie(read.selector, read.shader) = readRule(rule.text);
      findNamed(read.selector, world);
    } catch (const ShaderError& error) { throw read.wrong(error.what()); }
    if (read.selector.kind == Selector::Kind::rest)
      rest = std::move(read);
    else
      rules.push_back(std::move(read));
  }
  if (rest) rules.push_back(std::move(*rest));
  return rules;
}

// Returns the shapes that each rule gives its shader to. counts: how many each rule selects.
std::vector<std::vector<const SelectedShape*>> shapesByRule(const std::vector<ReadRule>& rules,
                                                            std::vector<SelectedShape>& shapes,
                                                            std::vector<size_t>& counts) {
  std::vector<std::vector<const SelectedShape*>> chosen(rules.size());
  const bool hasRest = !rules.empty() && rules.back().selector.kind == Selector::Kind::rest;
  for (SelectedShape& one : shapes) {
    const bool isRest = one.rule == SelectedShape::none && hasRest && !one.hasShader;
    if (isRest) one.rule = rules.size() - 1;
    if (isRest) ++counts.back();
    if (one.rule != SelectedShape::none) chosen[one.rule].push_back(&one);
  }
  return chosen;
}

} // namespace

void checkShaderRule(const std::string& text) { readRule(text); }

std::vector<ShaderRule> readShaderRules(const std::string& path) {
  std::string text;
  try {
    text = fileContents(path, rulesFileBytes);
  } catch (const std::runtime_error& why) {
    throw std::runtime_error(fmt::format("cannot read the rules in {}: {}", path, why.what()));
  }
  if (text.starts_with(byteOrderMark)) text.erase(0, byteOrderMark.size());
  std::vector<ShaderRule> rules;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = fmt::format("{}:{}:", path, number);
    if (line.find('\0') != line.npos)
      throw std::runtime_error(where + " text was expected, not a byte that is 0");
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    try {
      checkShaderRule(line);
    } catch (const ShaderError& error) {
      throw std::runtime_error(fmt::format("{} {}", where, error.what()));
    }
    rules.push_back({line, where, {}, false});
  }
  return rules;
}

size_t applyShaderRules(const std::vector<ShaderRule>& written, const std::string& shaderPath,
                        World& world, const SetAppearance& set) {
  struct Read {
    NodeRef node;
    bool showsColour = true;
  };
  std::map<std::string, Read> shaders; // rules with one text share a shader
  const std::vector<ReadRule> rules = readRules(written, world);
  std::vector<Selector> selectors;
  for (const ReadRule& rule : rules) selectors.push_back(rule.selector);
  std::vector<size_t> counts;
  std::vector<SelectedShape> shapes = selectShapes(selectors, world, counts);
  const auto chosen = shapesByRule(rules, shapes, counts);
  size_t given = 0;
  for (size_t i = 0; i < rules.size(); ++i) {
    const ReadRule& rule = rules[i];
    const ShaderRule& text = *rule.written;
    using Kind = Selector::Kind;
    if (counts[i] == 0 && text.mayMatchNothing) continue;
    Read& shader = shaders[rule.shader + '\n' + text.folder];
    if (!shader.node)
      shader.node = readShader(rule.shader, text.where.c_str(), RT_SURFACE, shaderPath, text.folder,
                               &shader.showsColour);
    if (counts[i] == 0 && rule.selector.kind == Kind::name)
      throw rule.wrong(fmt::format("{} is not part of a shape, and no shape is below it",
                                   rule.selector.pattern));
    if (counts[i] == 0 && rule.selector.kind != Kind::rest)
      world.diagnostics.warn(
          {}, fmt::format("{} {}: no shape of the world matches", text.where, text.text));
    if (rule.selector.kind == Kind::rest && !shader.showsColour) {
      if (const size_t colours = countColours(chosen[i]); colours > 1)
        world.diagnostics.warn(
            {}, fmt::format("{} {}: the class has no parameter for a material's colour: shapes of "
                            "{} colours become alike",
                            text.where, text.text, colours));
    }
    give(chosen[i], shader.node, rule.selector.kind == Kind::rest, world, set);
    given += chosen[i].size();
  }
  return given;
}

std::vector<ShapeRule> rulesOfShapes(const std::vector<ShaderRule>& written, const World& world) {
  const std::vector<ReadRule> rules = readRules(written, world);
  std::vector<Selector> selectors;
  for (const ReadRule& rule : rules) selectors.push_back(rule.selector);
  std::vector<size_t> counts;
  std::vector<ShapeRule> shapes;
  for (SelectedShape& one : selectShapes(selectors, world, counts))
    shapes.push_back({one.shape, std::move(one.kicad),
                      one.rule == SelectedShape::none ? nullptr : rules[one.rule].written});
  return shapes;
}

} // namespace picture
