// write_renderer.cpp: writes the classes with a callback per node type, from which renderers derive
// (xvrml/renderer.h), and the functions that call them.
#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

// Scripts come only from files, where each has a type of its own.
std::string classOf(const TypeSpec& type) {
  return type.name == "Script" ? "ScriptNode" : "nodes::" + type.name;
}

// Returns the name of the class with a plug-in's callbacks: SpringsRenderer for springs.
std::string classOfPlugin(std::string plugin) {
  if (plugin[0] >= 'a' && plugin[0] <= 'z') plugin[0] = char(plugin[0] - 'a' + 'A');
  return plugin + "Renderer";
}

std::string callback(const TypeSpec& type, std::string_view parameters, std::string_view result) {
  return fmt::format("  /// {}\n  virtual Visit render{}({}& {}) {{ return {}; }}\n", type.text,
                     type.name, classOf(type), parameters, result);
}

} // namespace

std::string writeRenderer(const Model& model) {
  std::string text = cppNotice();
  text +=
      "// NodeRenderer: the callbacks of renderers, one for each node type (xvrml/renderer.h).\n"
      "#pragma once\n\n#include <cstdint>\n\n#include \"xvrml/nodes.h\"\n"
      "#include \"xvrml/world.h\"\n\nnamespace xvrml {\n\n"
      "enum class Visit : uint8_t;\nstruct RenderState;\n\n"
      "class NodeRenderer {\n public:\n  virtual ~NodeRenderer() = default;\n"
      "  /// Any node without a callback of its own; goes on into its children.\n"
      "  virtual Visit render(Node& node, const RenderState& state);\n"
      "  /// The children of a node have been visited.\n"
      "  virtual void leave(Node& node, const RenderState& state);\n"
      "  /// An instance of a prototype; its child is the first node of the body.\n"
      "  virtual Visit renderInstance(ProtoInstance& instance, const RenderState& state) {\n"
      "    return render(instance, state);\n  }\n\n";
  eachNode(model, [&](const TypeSpec& type) {
    text += callback(type, "node, const RenderState& state", "render(node, state)");
  });
  return text + "};\n\n} // namespace xvrml\n";
}

std::string writeRendererCalls(const Model& model) {
  std::string text = cppNotice();
  text += "// Calls the callback of a renderer for a node.\n#include \"render/call.h\"\n\n"
          "namespace xvrml {\n\n"
          "Visit callFor(NodeRenderer& renderer, Node& node, const RenderState& state) {\n"
          "  switch (node.type().index) {\n"
          "  case ProtoInstance::typeIndex:\n"
          "    return renderer.renderInstance(static_cast<ProtoInstance&>(node), state);\n";
  eachNode(model, [&](const TypeSpec& type) {
    text += fmt::format("  case {1}::typeIndex:\n"
                        "    return renderer.render{0}(static_cast<{1}&>(node), state);\n",
                        type.name, classOf(type));
  });
  return text + "  default: return renderer.render(node, state);\n  }\n}\n\n} // namespace xvrml\n";
}

std::string writePluginRenderer(const Model& model, const std::string& plugin) {
  const std::string name = classOfPlugin(plugin);
  std::string text = fmt::format(
      "namespace xvrml {{\n\n"
      "/// The callbacks for the nodes of the plug-in {0}. A renderer that derives from this "
      "class, "
      "too, gets\n/// them before the nodes that they expand to, which are their children.\n"
      "class {1} {{\n public:\n  virtual ~{1}() = default;\n",
      plugin, name);
  eachNode(model, [&](const TypeSpec& type) {
    text += callback(type, "/*node*/, const RenderState& /*state*/", "Visit::children");
  });
  return text + "};\n\n} // namespace xvrml\n";
}

std::string writePluginCall(const TypeSpec& type, const std::string& plugin) {
  return fmt::format("static bool render{0}(Renderer& renderer, Node& node, const RenderState& "
                     "state, Visit& visit) {{\n"
                     "  auto* own = dynamic_cast<{1}*>(&renderer);\n"
                     "  if (own) visit = own->render{0}(static_cast<{0}&>(node), state);\n"
                     "  return own != nullptr;\n}}\n",
                     type.name, classOfPlugin(plugin));
}

} // namespace xvrml::nodegen
