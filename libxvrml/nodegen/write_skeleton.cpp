// write_skeleton.cpp: the first source of a node's behaviour, which its author then owns: a handler per event it receives.
#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

bool receives(const FieldSpec& field) { return field.access == Access::eventIn || field.access == Access::exposedField; }

std::string handler(const TypeSpec& type, const FieldSpec& field) {
  const bool stored = field.hasStorage();
  const std::string parameters =
      fmt::format("{}& {}, const {}& value", type.name, stored ? "node" : "/*node*/", fieldTypeName(field.type));
  const std::string body = stored ? fmt::format("node.{} = value;", cppMember(field)) : "(void)value;";
  return fmt::format("// {}\nvoid receive_{}({}) {{ {} }}\n\n", field.text, field.name, parameters, body);
}

} // namespace

std::string writeSkeleton(const TypeSpec& type) {
  std::string text =
      fmt::format("// {}: {}\n// Written once by nodegen --skeleton; it is yours from here on.\n", type.name, type.text);
  text += "#include <string_view>\n\n#include \"xvrml/nodes.h\"\n\nnamespace {\n\nusing namespace xvrml;\n"
          "using xvrml::nodes::" +
          type.name + ";\n\n";
  std::string dispatch;
  for (const FieldSpec& field : type.fields) {
    if (!receives(field)) continue;
    text += handler(type, field);
    dispatch += fmt::format("  if (field.name == {}) receive_{}(node, std::get<{}>(value));\n", cppString(field.name), field.name,
                            fieldTypeName(field.type));
  }
  text += "} // namespace\n\n";
  text += fmt::format("// Called for each event that reaches a {0}; the value is of the field's type.\n"
                      "void receive{0}({0}& node, const FieldInfo& field, const Value& value) {{\n{1}}}\n",
                      type.name, dispatch.empty() ? "  (void)node, (void)field, (void)value;\n" : dispatch);
  return text;
}

} // namespace xvrml::nodegen
