#include "libpicture/shader_selector.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "libpicture/shader_text.h"
#include "libpicture/walk.h"
#include "nearest.h"
#include "xvrml/appearance.h"

namespace picture {

namespace {

using namespace xvrml;

constexpr std::string_view blanks = " \t\r";
constexpr float colourTolerance = 0.03f, shininessTolerance = 0.0051f;

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

// Returns whether a material has the numbers of a rule for colours.
bool hasColour(Node* material, const std::vector<float>& wanted) {
  const auto near = [](float a, float b, float within) { return std::abs(a - b) <= within; };
  const MaterialValues values = materialValues(material);
  using Model = MaterialValues::Model;
  if (values.model != Model::phong && values.model != Model::physical) return false;
  const float own[] = {values.color.r, values.color.g, values.color.b};
  for (size_t k = 0; k < 3; ++k)
    if (!near(own[k], wanted[k], colourTolerance)) return false;
  if (wanted.size() == 3) return true;
  return values.model == Model::phong && near(values.shininess, wanted[3], shininessTolerance);
}

// Returns whether a node that is written, or the one drawn in its place, has a matching DEF name.
bool isNamed(const Node* written, const Node* drawn, const std::string& pattern) {
  return (written && matchesGlob(pattern, written->defName)) ||
         (drawn && matchesGlob(pattern, drawn->defName));
}

// Returns whether a selector, but for *, selects a shape.
bool selects(const Selector& selector, const nodes::Shape& shape, const KicadMaterial& kicad) {
  using Kind = Selector::Kind;
  Node* const appearance = renderedNode(shape.appearance.get());
  const NodeRef written = writtenParts(appearance).material;
  Node* const material = renderedNode(written.get());
  switch (selector.kind) {
  case Kind::material: return isNamed(written.get(), material, selector.pattern);
  case Kind::appearance: return isNamed(shape.appearance.get(), appearance, selector.pattern);
  case Kind::shape: return matchesGlob(selector.pattern, shape.defName);
  case Kind::kicad: return !kicad.name.empty() && matchesGlob(selector.pattern, kicad.name);
  case Kind::colour: return hasColour(material, selector.colour);
  case Kind::name:
    return selector.below.contains(&shape) || selector.below.contains(shape.appearance.get()) ||
           selector.below.contains(appearance) || selector.below.contains(written.get());
  case Kind::rest: break;
  }
  return false;
}

} // namespace

std::string trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  return std::string(text.substr(begin, text.find_last_not_of(blanks) + 1 - begin));
}

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

Selector readSelector(const std::string& text) {
  using Kind = Selector::Kind;
  if (text == "*") return {};
  constexpr std::pair<std::string_view, Kind> kinds[] = {
      {"material:", Kind::material}, {"appearance:", Kind::appearance}, {"shape:", Kind::shape},
      {"kicad:", Kind::kicad},       {"colour:", Kind::colour},         {"color:", Kind::colour}};
  for (const auto& [prefix, kind] : kinds) {
    if (!text.starts_with(prefix)) continue;
    std::string pattern = trimmed(text.substr(prefix.size()));
    if (kind == Kind::colour) return {kind, {}, readColour(pattern)};
    if (pattern.empty())
      throw ShaderError(
          fmt::format("a name was expected after {}, such as {}PIN-*", prefix, prefix));
    return {kind, std::move(pattern), {}};
  }
  return {Kind::name, text, {}};
}

void findNamed(Selector& selector, const World& world) {
  if (selector.kind != Selector::Kind::name) return;
  const auto add = [&](const Node& one) { selector.below.insert(&one); };
  walkInto(NodeList{&findNode(selector.pattern, world)}, add, [](const Scope&) {});
}

WrittenParts writtenParts(Node* appearance) {
  if (auto* plain = nodeCast<nodes::Appearance>(appearance))
    return {plain->material, plain->texture, plain->textureTransform, {}};
  if (auto* own = nodeCast<nodes::ORTAppearance>(appearance))
    return {own->material, own->texture, own->textureTransform, own->shader};
  return {};
}

std::vector<SelectedShape> selectShapes(const std::vector<Selector>& selectors, const World& world,
                                        std::vector<size_t>& counts) {
  std::vector<SelectedShape> shapes;
  counts.assign(selectors.size(), 0);
  std::optional<KicadMaterials> kicad;
  for (const Selector& selector : selectors)
    if (selector.kind == Selector::Kind::kicad && !kicad) kicad.emplace(world);
  const auto visit = [&](const Node& node) {
    auto* shape = nodeCast<nodes::Shape>(const_cast<Node*>(&node));
    if (!shape) return;
    SelectedShape one{shape, kicad ? kicad->of(*shape) : KicadMaterial(), false};
    one.hasShader = bool(writtenParts(renderedNode(shape->appearance.get())).shader);
    for (size_t i = 0; i < selectors.size(); ++i)
      if (selects(selectors[i], *shape, one.kicad)) {
        ++counts[i];
        one.rule = i;
      }
    shapes.push_back(std::move(one));
  };
  walkInto(world.scope, visit, [](const Scope&) {});
  return shapes;
}

} // namespace picture
