// write_skeleton.cpp: the first source of a node's behaviour, which its author then owns: a handler per eventIn, and one place
// where all events of the node arrive.
#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

std::string handler(const TypeSpec& type, const FieldSpec& field) {
  return fmt::format(
      "// {}\nvoid on_{}({}&, const Value& value) {{\n  [[maybe_unused]] const {}& received = std::get<{}>(value);\n}}\n\n",
      field.text, field.name, type.name, fieldTypeName(field.type), fieldTypeName(field.type));
}

} // namespace

std::string writeSkeleton(const TypeSpec& type) {
  std::string handlers, rows;
  for (const FieldSpec& field : type.fields) {
    if (field.access != Access::eventIn) continue;
    handlers += handler(type, field);
    rows += fmt::format("    {{{}, on_{}}},\n", cppString(field.name), field.name);
  }
  const std::string table = rows.empty()
                                ? ""
                                : fmt::format("constexpr struct {{\n  std::string_view event;\n"
                                              "  void (*receive)({}& node, const Value& value);\n}} handlers[] = {{\n{}}};\n\n",
                                              type.name, rows);
  const std::string search = rows.empty() ? ""
                                          : "  for (const auto& handler : handlers)\n"
                                            "    if (handler.event == field.name) handler.receive(node, value);\n";
  return fmt::format("// {0}: {1}\n// Written once by nodegen --skeleton; it is yours from here on.\n"
                     "#include <string_view>\n\n#include \"xvrml/nodes.h\"\n\nnamespace {{\n\nusing namespace xvrml;\n"
                     "using xvrml::nodes::{0};\n\n{2}{3}"
                     "// An event has reached a node; the value is of the field's type.\n"
                     "[[maybe_unused]] void receive({0}& node, const FieldInfo& field, const Value& value) {{\n"
                     "  if (field.access == Access::exposedField) node.set(field, value);\n{4}}}\n\n}} // namespace\n",
                     type.name, type.text, handlers, table, search);
}

} // namespace xvrml::nodegen
