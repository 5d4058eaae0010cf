#include "libpicture/shader_rules.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "libpicture/walk.h"
#include "nearest.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace picture {

namespace {

using namespace xvrml;

constexpr float colourTolerance = 0.03f, shininessTolerance = 0.0051f;
constexpr size_t rulesFileBytes = 1 << 20; // a longer file is refused
constexpr std::string_view blanks = " \t\r", byteOrderMark = "\xef\xbb\xbf";

// Says what a rule selects.
struct Selector {
  enum class Kind : uint8_t { rest, name, material, appearance, shape, colour } kind;
  std::string pattern;
  std::vector<float> colour; // red, green, blue, and the shininess if it counts
};

// The nodes of an appearance, as written in the file.
struct Parts {
  NodeRef material, texture, textureTransform, shader;
};

Parts partsOf(Node* appearance) {
  if (auto* plain = nodeCast<nodes::Appearance>(appearance))
    return {plain->material, plain->texture, plain->textureTransform, {}};
  if (auto* own = nodeCast<nodes::ORTAppearance>(appearance))
    return {own->material, own->texture, own->textureTransform, own->shader};
  return {};
}

std::vector<float> readColour(const std::string& text) {
  std::vector<float> out;
  const char *at = text.data(), *end = text.data() + text.size();
  for (;; ++at) {
    float value = 0;
    const auto read = std::from_chars(at, end, value);
    at = read.ptr;
    if (read.ec != std::errc() || !(value >= 0 && value <= 1) || out.size() == 4) break;
    out.push_back(value);
    if (at == end && out.size() >= 3) return out;
    if (at == end || *at != ',') break;
  }
  throw ShaderError(fmt::format("colour: R,G,B from 0 to 1, as in diffuseColor, with or without "
                                "the shininess behind, was expected, not \"{}\"",
                                text));
}

std::string trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  return std::string(text.substr(begin, text.find_last_not_of(blanks) + 1 - begin));
}

// Splits a rule into its selector and the text of its shader.
std::pair<Selector, std::string> readRule(const std::string& text) {
  using Kind = Selector::Kind;
  const size_t equals = text.find('=');
  if (equals == text.npos || trimmed(text.substr(0, equals)).empty())
    throw ShaderError(
        fmt::format("SELECTOR=CLASS[:PARAM=VALUE...] was expected, not \"{}\"", text));
  const std::string selector = trimmed(text.substr(0, equals)),
                    shader = trimmed(text.substr(equals + 1));
  if (selector == "*") return {{Kind::rest, {}, {}}, shader};
  constexpr std::pair<std::string_view, Kind> kinds[] = {{"material:", Kind::material},
                                                         {"appearance:", Kind::appearance},
                                                         {"shape:", Kind::shape},
                                                         {"colour:", Kind::colour},
                                                         {"color:", Kind::colour}};
  for (const auto& [prefix, kind] : kinds) {
    if (!selector.starts_with(prefix)) continue;
    std::string pattern = trimmed(selector.substr(prefix.size()));
    if (kind == Kind::colour) return {{kind, {}, readColour(pattern)}, shader};
    if (pattern.empty())
      throw ShaderError(
          fmt::format("a name was expected after {}, such as {}PIN-*", prefix, prefix));
    return {{kind, std::move(pattern), {}}, shader};
  }
  return {{Kind::name, selector, {}}, shader};
}

// Returns the node with a DEF name in the world's own file.
Node& findNode(const std::string& name, const World& world) {
  if (const auto found = world.scope.names.find(name); found != world.scope.names.end())
    return *found->second;
  std::vector<std::string> known;
  for (const auto& [one, node] : world.scope.names) known.push_back(one);
  const std::string near = nearest::word(name, known);
  throw ShaderError(known.empty()
                        ? "no node of the world has a DEF name; use * for all shapes"
                        : fmt::format("no node is called {}{}", name,
                                      near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

// Returns the values of a material that rules find by its colour; none for one that is not lit.
std::optional<MaterialValues> litValues(Node* material) {
  const MaterialValues values = materialValues(material);
  using Model = MaterialValues::Model;
  const bool isLit = values.model == Model::phong || values.model == Model::physical;
  return isLit ? std::optional(values) : std::nullopt;
}

// Returns whether a material has the numbers of a rule for colours.
bool hasColour(Node* material, const std::vector<float>& wanted) {
  const auto near = [](float a, float b, float within) { return std::abs(a - b) <= within; };
  const std::optional<MaterialValues> values = litValues(material);
  if (!values) return false;
  const float own[] = {values->color.r, values->color.g, values->color.b};
  for (size_t k = 0; k < 3; ++k)
    if (!near(own[k], wanted[k], colourTolerance)) return false;
  if (wanted.size() == 3) return true;
  return values->model == MaterialValues::Model::phong &&
         near(values->shininess, wanted[3], shininessTolerance);
}

// Returns whether a node that is written, or the one drawn in its place, has a matching DEF name.
bool isNamed(const Node* written, const Node* drawn, const std::string& pattern) {
  return (written && matchesGlob(pattern, written->defName)) ||
         (drawn && matchesGlob(pattern, drawn->defName));
}

// Returns the shapes that the rule selects, in the order of a walk. `below`: the named node and all
// nodes below it.
std::vector<nodes::Shape*> shapesOf(const World& world, const Selector& selector,
                                    const std::set<const Node*>& below) {
  using Kind = Selector::Kind;
  const auto selects = [&](nodes::Shape& shape) {
    Node* const appearance = renderedNode(shape.appearance.get());
    const Parts parts = partsOf(appearance);
    Node* const material = renderedNode(parts.material.get());
    switch (selector.kind) {
    case Kind::rest: return !parts.shader;
    case Kind::material: return isNamed(parts.material.get(), material, selector.pattern);
    case Kind::appearance: return isNamed(shape.appearance.get(), appearance, selector.pattern);
    case Kind::shape: return matchesGlob(selector.pattern, shape.defName);
    case Kind::colour: return hasColour(material, selector.colour);
    default:
      return below.contains(&shape) || below.contains(shape.appearance.get()) ||
             below.contains(appearance) || below.contains(parts.material.get());
    }
  };
  std::vector<nodes::Shape*> shapes;
  const auto visit = [&](const Node& node) {
    auto* shape = nodeCast<nodes::Shape>(const_cast<Node*>(&node));
    if (shape && selects(*shape)) shapes.push_back(shape);
  };
  walkInto(world.scope, visit, [](const Scope&) {});
  return shapes;
}

// Returns the number of different colours that the materials of the shapes have.
size_t countColours(const std::vector<nodes::Shape*>& shapes) {
  std::set<std::array<float, 3>> colours;
  for (const nodes::Shape* shape : shapes) {
    const Parts parts = partsOf(renderedNode(shape->appearance.get()));
    if (const auto values = litValues(parts.material.get()))
      colours.insert({values->color.r, values->color.g, values->color.b});
  }
  return colours.size();
}

NodeRef makeNode(const char* typeName) {
  const NodeType& type = *findNodeType(typeName);
  return NodeRef(type.create(type));
}

// Gives shapes an appearance with this shader. addMaterial: one without a material gets a Material,
// so that its colour is not the shader's default.
void give(const std::vector<nodes::Shape*>& shapes, const NodeRef& shader, bool addMaterial,
          World& world, const SetAppearance& set) {
  std::map<const Node*, NodeRef> made; // keeps shared appearances shared
  for (nodes::Shape* shape : shapes) {
    Node* before = renderedNode(shape->appearance.get());
    NodeRef& appearance = made[before];
    if (!appearance) {
      appearance = makeNode("ORTAppearance");
      auto& own = static_cast<nodes::ORTAppearance&>(*appearance);
      const Parts parts = partsOf(before);
      own.material = parts.material || !addMaterial ? parts.material : makeNode("Material");
      own.texture = parts.texture;
      own.textureTransform = parts.textureTransform;
      own.shader = shader;
      own.source = shader->source;
      if (before) own.defName = before->defName;
      for (auto& [name, node] : world.scope.names)
        if (before && node.get() == before) node = appearance;
    }
    if (set)
      set(*shape, appearance);
    else
      shape->appearance = appearance;
  }
}

} // namespace

// Goes back to the last * only, so that no pattern takes longer than the product of both lengths.
bool matchesGlob(std::string_view pattern, std::string_view name) {
  size_t p = 0, n = 0, star = pattern.npos, from = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != pattern.npos) {
      p = star + 1;
      n = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

void checkShaderRule(const std::string& text) { readRule(text); }

std::vector<ShaderRule> readShaderRules(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(rulesFileBytes + 1, '\0');
  if (file) file.read(text.data(), std::streamsize(text.size()));
  if (file.bad() || !file.is_open() || (file.gcount() == 0 && !file.eof()))
    throw std::runtime_error(fmt::format("cannot read the rules in {}", path));
  text.resize(size_t(file.gcount()));
  if (text.size() > rulesFileBytes)
    throw std::runtime_error(
        fmt::format("{} is longer than {} bytes, too long for rules", path, rulesFileBytes));
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
  using Kind = Selector::Kind;
  size_t given = 0;
  struct Read {
    NodeRef node;
    bool showsColour = true;
  };
  std::map<std::string, Read> shaders; // rules with one text share a shader
  // Rules for the rest come last. The last one of them gets all that is left.
  std::vector<ShaderRule> rules, rest;
  for (const ShaderRule& rule : written) {
    if (trimmed(rule.text.substr(0, rule.text.find('='))) == "*")
      rest.insert(rest.begin(), rule);
    else
      rules.push_back(rule);
  }
  rules.insert(rules.end(), rest.begin(), rest.end());
  for (const ShaderRule& rule : rules) {
    const auto wrong = [&](const std::string& why) {
      return ShaderError(fmt::format("{} {}: {}", rule.where, rule.text, why));
    };
    Selector selector;
    std::string shaderText;
    std::set<const Node*> below;
    try {
      std::tie(selector, shaderText) = readRule(rule.text);
      if (selector.kind == Kind::name) {
        const auto add = [&](const Node& one) { below.insert(&one); };
        walkInto(NodeList{&findNode(selector.pattern, world)}, add, [](const Scope&) {});
      }
    } catch (const ShaderError& error) { throw wrong(error.what()); }
    const std::vector<nodes::Shape*> shapes = shapesOf(world, selector, below);
    if (shapes.empty() && rule.mayMatchNothing) continue;
    Read& shader = shaders[shaderText + '\n' + rule.folder];
    if (!shader.node)
      shader.node = readShader(shaderText, rule.where.c_str(), RT_SURFACE, shaderPath, rule.folder,
                               &shader.showsColour);
    if (shapes.empty() && selector.kind == Kind::name)
      throw wrong(
          fmt::format("{} is not part of a shape, and no shape is below it", selector.pattern));
    if (shapes.empty() && selector.kind != Kind::rest)
      world.diagnostics.warn(
          {}, fmt::format("{} {}: no shape of the world matches", rule.where, rule.text));
    if (selector.kind == Kind::rest && !shader.showsColour) {
      if (const size_t colours = countColours(shapes); colours > 1)
        world.diagnostics.warn(
            {}, fmt::format("{} {}: the class has no parameter for a material's colour: shapes of "
                            "{} colours become alike",
                            rule.where, rule.text, colours));
    }
    give(shapes, shader.node, selector.kind == Kind::rest, world, set);
    given += shapes.size();
  }
  return given;
}

} // namespace picture
