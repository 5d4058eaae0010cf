#include "shader_changes.h"

#include <map>
#include <set>

#include <fmt/format.h>

#include "nearest.h"
#include "report/describe.h"
#include "shader_text.h"
#include "values.h"
#include "xvrml/nodes.h"

namespace vv {

namespace {

using namespace xvrml;

[[noreturn]] void fail(const std::string& text, const std::string& why) {
  throw Failure{exitUsage, fmt::format("--shader {}: {}", text, why)};
}

Node& findNode(const std::string& text, const std::string& name, const World& world) {
  if (const auto found = world.scope.names.find(name); found != world.scope.names.end())
    return *found->second;
  std::vector<std::string> known;
  for (const auto& [one, node] : world.scope.names) known.push_back(one);
  const std::string near = nearest::word(name, known);
  fail(text, known.empty()
                 ? "no node of the world has a DEF name; use * for all shapes"
                 : fmt::format("no node is called {}{}", name,
                               near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

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

// Returns the shapes that contain, or stand below, one of these nodes; null: all shapes without a
// shader.
std::vector<nodes::Shape*> shapesOf(const World& world, const std::set<const Node*>* nodes) {
  std::vector<nodes::Shape*> shapes;
  forEachNode(world, [&](const Node& node) {
    auto* shape = nodeCast<nodes::Shape>(const_cast<Node*>(&node));
    if (!shape) return;
    Node* appearance = renderedNode(shape->appearance.get());
    const Parts parts = partsOf(appearance);
    if (nodes ? nodes->contains(shape) || nodes->contains(shape->appearance.get()) ||
                    nodes->contains(appearance) || nodes->contains(parts.material.get())
              : !parts.shader)
      shapes.push_back(shape);
  });
  return shapes;
}

void give(const std::vector<nodes::Shape*>& shapes, const NodeRef& shader, World& world) {
  const NodeType& type = *findNodeType("ORTAppearance");
  std::map<const Node*, NodeRef> made; // keeps shared appearances shared
  for (nodes::Shape* shape : shapes) {
    Node* before = renderedNode(shape->appearance.get());
    NodeRef& appearance = made[before];
    if (!appearance) {
      appearance = NodeRef(type.create(type));
      auto& own = static_cast<nodes::ORTAppearance&>(*appearance);
      const Parts parts = partsOf(before);
      own.material = parts.material;
      own.texture = parts.texture;
      own.textureTransform = parts.textureTransform;
      own.shader = shader;
      own.source = shader->source;
      if (before) own.defName = before->defName;
      for (auto& [name, node] : world.scope.names)
        if (before && node.get() == before) node = appearance;
    }
    shape->appearance = appearance;
  }
}

} // namespace

void changeShaders(const std::vector<std::string>& texts, const std::string& shaderPath,
                   World& world) {
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) fail(text, "DEF=CLASS[:PARAM=VALUE...] was expected");
    const std::string name = text.substr(0, equals);
    std::set<const Node*> below;
    if (name != "*") {
      Node& node = findNode(text, name, world);
      below.insert(&node);
      forEachNodeBelow(node, [&](const Node& one) { below.insert(&one); });
    }
    NodeRef shader;
    try {
      shader = readShader(text.substr(equals + 1), "--shader", RT_SURFACE, shaderPath);
    } catch (const UsageError& error) { throw Failure{exitUsage, error.what()}; }
    const std::vector<nodes::Shape*> shapes = shapesOf(world, name == "*" ? nullptr : &below);
    if (shapes.empty() && name != "*")
      fail(text, fmt::format("{} is not part of a shape, and no shape is below it", name));
    give(shapes, shader, world);
  }
}

} // namespace vv
