// write_skeleton.cpp: writes the first source file of a node's behaviour, which its author then
// edits: one handler per eventIn, and one function that receives all events of the node.
#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

std::string handler(const TypeSpec& type, const FieldSpec& field) {
  return fmt::format("// {}\nvoid on_{}({}&, const Value& value) {{\n  [[maybe_unused]] const {}& "
                     "received = std::get<{}>(value);\n}}\n\n",
                     field.text, field.name, type.name, fieldTypeName(field.type),
                     fieldTypeName(field.type));
}

// Returns the skeleton of a plug-in's node. The engine handles events; the author adds the node's
// own reaction.
std::string pluginSkeleton(const TypeSpec& type, const std::string& plugin) {
  std::string events;
  for (const FieldSpec& field : type.fields)
    if (field.access == Access::eventIn || field.access == Access::exposedField)
      events += fmt::format("  // {}: {} {}\n", field.name, fieldTypeName(field.type), field.text);
  return fmt::format(
      "// {0}: {1}\n// Written once by nodegen --skeleton; it is yours from here on.\n"
      "#include \"{2}_nodes.h\"\n#include \"xvrml/nodes.h\"\n\nnamespace {{\n\nusing namespace "
      "xvrml;\nusing xvrml::nodes::{0};\n\n"
      "// An event has reached a node; an exposedField holds the value and has sent it on already. "
      "events.send() sends,\n"
      "// events.store() changes a field, events.now() is the time.\n{3}"
      "void receive(Events&, Node& node, const FieldInfo&, const Value&) {{\n"
      "  [[maybe_unused]] auto& self = static_cast<{0}&>(node);\n}}\n\n"
      "// The standard nodes that the node stands for, made from its fields; null: nothing is "
      "drawn.\n"
      "NodeRef expand(const Node& node) {{\n  [[maybe_unused]] const auto& self = "
      "static_cast<const {0}&>(node);\n"
      "  return {{}};\n}}\n\n}} // namespace\n\n"
      "const xvrml::NodeImplementation xvrml::nodes::{0}::implementation = {{.behaviour = "
      "{{.receive = receive}}, .expand = expand}};\n",
      type.name, type.text, plugin, events);
}

} // namespace

std::string writeSkeleton(const TypeSpec& type, const std::string& plugin) {
  if (!plugin.empty()) return pluginSkeleton(type, plugin);
  std::string handlers, rows;
  for (const FieldSpec& field : type.fields) {
    if (field.access != Access::eventIn) continue;
    handlers += handler(type, field);
    rows += fmt::format("    {{{}, on_{}}},\n", cppString(field.name), field.name);
  }
  const std::string table =
      rows.empty()
          ? ""
          : fmt::format(
                "constexpr struct {{\n  std::string_view event;\n"
                "  void (*receive)({}& node, const Value& value);\n}} handlers[] = {{\n{}}};\n\n",
                type.name, rows);
  const std::string search =
      rows.empty() ? ""
                   : "  for (const auto& handler : handlers)\n"
                     "    if (handler.event == field.name) handler.receive(node, value);\n";
  return fmt::format(
      "// {0}: {1}\n// Written once by nodegen --skeleton; it is yours from here on.\n"
      "#include <string_view>\n\n#include \"xvrml/nodes.h\"\n\nnamespace {{\n\nusing namespace "
      "xvrml;\n"
      "using xvrml::nodes::{0};\n\n{2}{3}"
      "// An event has reached a node; the value is of the field's type.\n"
      "[[maybe_unused]] void receive({0}& node, const FieldInfo& field, const Value& value) {{\n"
      "  if (field.access == Access::exposedField) node.set(field, value);\n{4}}}\n\n}} // "
      "namespace\n",
      type.name, type.text, handlers, table, search);
}

} // namespace xvrml::nodegen
