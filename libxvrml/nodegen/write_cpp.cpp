// write_cpp.cpp: writes the generated C++: a header of structs, one source of constant tables per
// component, and the list of types.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

// Returns the sentence that names the standard and the clause, after a blank.
std::string clauseSentence(const TypeSpec& type) {
  const std::string clause = clauseText(type);
  return clause.empty() ? clause : ' ' + clause + '.';
}

// Returns NodeRow::standard.
std::string_view standardInRow(const TypeSpec& type) {
  if (type.ofX3d) return "Standard::x3d";
  return type.clause.empty() ? "Standard::none" : "Standard::vrml97";
}

// Returns FieldRow::words.
std::string wordsOf(const FieldSpec& field) {
  std::string words;
  const auto add = [&](bool says, std::string_view word) {
    if (says) words += (words.empty() ? "" : " | ") + std::string(word);
  };
  add(field.urls, "fieldHoldsUrls");
  add(field.ofX3d, "fieldOfX3d");
  return words.empty() ? "0" : words;
}

std::string writeMember(const FieldSpec& field) {
  const std::string initializer = cppInitializer(field.value);
  const std::string declaration =
      fmt::format("{} {}{};", fieldTypeName(field.type), cppMember(field),
                  initializer.empty() ? std::string() : '{' + initializer + '}');
  const std::string range =
      field.rangeText.empty() || !field.range->bounded() ? std::string() : ' ' + field.rangeText;
  return fmt::format("  {} ///< {}{}: {}\n", declaration, accessName(field.access), range,
                     field.text);
}

// A plug-in's types get their index when it is loaded, and each node has room for its expansion.
constexpr std::string_view pluginMembers =
    "  static int typeIndex;\n  static const NodeType& nodeType();\n"
    "  static const NodeImplementation implementation; // in the plug-in's own source\n"
    "  NodeRef* expansion() override { return &standsFor_; }\n";

std::string writeStruct(const TypeSpec& type, bool plugin) {
  const bool declares =
      std::find(type.roles.begin(), type.roles.end(), "declaring") != type.roles.end();
  const std::string_view base = declares ? "DeclaringNode" : "Node";
  std::string text = fmt::format("/// {}{}\nstruct {} : {} {{\n", type.text, clauseSentence(type),
                                 type.name, base);
  if (plugin)
    text += pluginMembers;
  else
    text += fmt::format(
        "  static constexpr int typeIndex = {};\n  static const NodeType& nodeType();\n",
        type.number);
  text += fmt::format(
      "  {0}() : {1}(nodeType()) {{}}\n  explicit {0}(const NodeType& t) : {1}(t) {{}}\n",
      type.name, base);
  std::string members, rare;
  for (const FieldSpec& field : type.fields)
    if (field.hasStorage())
      (field.rare ? rare : members) += (field.rare ? "  " : "") + writeMember(field);
  if (!rare.empty()) members += "  struct Rare {\n" + rare + "  };\n  RareFields<Rare> rare;\n";
  if (plugin) members += "\n private:\n  NodeRef standsFor_;\n";
  return text + (members.empty() ? "" : "\n") + members + "};\n\n";
}

std::string number(double value) {
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  return fmt::format("{}", value);
}

std::string writeRange(const std::optional<FieldRange>& range) {
  if (!range || !range->bounded()) return "{}";
  const std::string also = std::isnan(range->also) ? std::string() : ", " + number(range->also);
  return fmt::format("{{{}, {}, {}, {}{}}}", number(range->minimum), number(range->maximum),
                     range->minimumOpen, range->maximumOpen, also);
}

std::string writeRow(const TypeSpec& type, const FieldSpec& field) {
  const std::string offset =
      field.hasStorage()
          ? fmt::format("offsetof({}, {})", type.name, field.rare ? "rare" : cppMember(field))
          : "0";
  const std::string rare = field.rare
                               ? fmt::format(", &rareAccess<{0}::Rare>, offsetof({0}::Rare, {1})",
                                             type.name, cppMember(field))
                               : std::string();
  return fmt::format("    {{{}, FieldType::{}, Access::{}, Change::{}, {}, {}, {}, {}, {}{}}},\n",
                     cppString(field.name), fieldTypeName(field.type), accessName(field.access),
                     changeName(*field.change), wordsOf(field), offset, writeRange(field.range),
                     cppString(joinNames(field.accepts)), cppString(field.text), rare);
}

std::string writeTable(const TypeSpec& type) {
  std::string fields = "{}", rows;
  if (!type.fields.empty()) {
    fields = fmt::format("fieldsOf{}", type.name);
    rows = fmt::format("constexpr FieldRow {}[] = {{\n", fields);
    for (const FieldSpec& field : type.fields) rows += writeRow(type, field);
    rows += "};\n";
  }
  rows += fmt::format(
      "constexpr NodeRow rowOf{0} = {{{1}, {2}, {3}, {4}, {5}, {6}, {7}, createNode<{0}>}};\n\n",
      type.name, cppString(type.name), cppString(fmt::format("{}", fmt::join(type.roles, " "))),
      cppString(type.component), standardInRow(type), cppString(type.clause), cppString(type.text),
      fields);
  return rows;
}

std::string libraryFunctions(const TypeSpec& type) {
  return fmt::format("const NodeType& {0}::nodeType() {{\n  static const NodeType type = "
                     "makeNodeType(rowOf{0}, typeIndex);\n"
                     "  return type;\n}}\n\n",
                     type.name);
}

std::string pluginFunctions(const TypeSpec& type, const std::string& plugin) {
  return writePluginCall(type, plugin) +
         fmt::format("int {0}::typeIndex = -1;\nstatic const NodeType* typeOf{0} = nullptr;\n"
                     "const NodeType& {0}::nodeType() {{ return *typeOf{0}; }}\n"
                     "static void register{0}(const NodeType& type) {{\n  typeOf{0} = &type;\n  "
                     "{0}::typeIndex = type.index;\n}}\n"
                     "NodePluginRow pluginRowOf{0}();\n"
                     "NodePluginRow pluginRowOf{0}() {{ return {{&rowOf{0}, &{0}::implementation, "
                     "register{0}, render{0}}}; }}\n\n",
                     type.name);
}

} // namespace

std::string cppNotice() {
  return "// Written by nodegen from the .node files: change those, not this.\n";
}

std::string writeHeader(const Model& model, const std::string& plugin) {
  std::string text = cppNotice();
  text += fmt::format("// A struct per node, with a member per field and exposedField. Use "
                      "nodeCast<nodes::Box>(node) to get at them.\n"
                      "#pragma once\n\n#include \"xvrml/{}.h\"\n\nnamespace xvrml::nodes {{\n\n",
                      plugin.empty() ? "node" : "node_plugin");
  eachNode(model, [&](const TypeSpec& type) { text += writeStruct(type, !plugin.empty()); });
  text += "} // namespace xvrml::nodes\n";
  return plugin.empty() ? text : text + '\n' + writePluginRenderer(model, plugin);
}

std::string writeTables(const Component& component, const std::string& plugin) {
  std::string text = cppNotice();
  text += fmt::format("// {}: the constant tables of its nodes.\n", component.title);
  text += "#include <cstddef>\n\n";
  text += plugin.empty() ? "#include \"xvrml/node_table.h\"\n#include \"xvrml/nodes.h\"\n\n"
                         : fmt::format("#include \"{}_nodes.h\"\n\n", plugin);
  text += "#pragma GCC diagnostic ignored \"-Winvalid-offsetof\" // one base, not virtual: GCC and "
          "Clang define it\n\n"
          "namespace xvrml::nodes {\nnamespace {\n\n"
          "[[maybe_unused]] constexpr double inf = std::numeric_limits<double>::infinity();\n\n";
  std::string functions;
  eachNode(component, [&](const TypeSpec& type) {
    text += writeTable(type);
    functions += plugin.empty() ? libraryFunctions(type) : pluginFunctions(type, plugin);
  });
  return text + "} // namespace\n\n" + functions + "} // namespace xvrml::nodes\n";
}

namespace {

// Returns the function `name`, which returns a table of `type`. rows: its lines; empty: no table.
std::string tableFunction(const char* type, const char* name, const std::string& rows) {
  const std::string body = rows.empty() ? "return {};"
                                        : fmt::format("static constexpr {} table[] = {{\n{}  }};\n"
                                                      "  return table;",
                                                      type, rows);
  return fmt::format("std::span<const {}> {}() {{\n  {}\n}}\n\n", type, name, body);
}

// The fields that hold nodes where X3D's XML does not say it, by node and by abstract type.
std::string writeContainers(const Model& model) {
  std::string rows;
  for (const Component& component : model.components)
    for (const TypeSpec& type : component.types)
      if (!type.container.empty())
        rows += fmt::format("      {{{}, {}}},\n", cppString(type.name), cppString(type.container));
  return tableFunction("Container", "containers", rows);
}

// Returns the table of what is not done of nodes that the library has.
std::string writeLacks(const Model& model) {
  std::string rows;
  eachNode(model, [&](const TypeSpec& type) {
    if (!type.lacks.empty())
      rows += fmt::format("      {{{}, {}}},\n", cppString(type.name), cppString(type.lacks));
  });
  return tableFunction("Lack", "lacks", rows);
}

// Calls use(revision, field, number of the node) for each field of each `since`, in the order of
// the numbers, then of the versions.
template <class Use> void eachRevision(const Model& model, Use use) {
  std::vector<std::pair<int, const Revision*>> all;
  for (const Component& component : model.components)
    for (const Revision& one : component.revisions)
      if (const TypeSpec* type = model.find(one.node.name)) all.emplace_back(type->number, &one);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.first, a.second->major, a.second->minor) <
           std::tuple(b.first, b.second->major, b.second->minor);
  });
  for (const auto& [number, one] : all)
    for (const FieldSpec& field : one->fields) use(*one, field, number);
}

// Returns the table of the fields that a version of X3D describes otherwise.
std::string writeRevisions(const Model& model) {
  std::string rows;
  eachRevision(model, [&](const Revision& one, const FieldSpec& field, int number) {
    rows += fmt::format("      {{{}, {}, {}, {}, Access::{}, {}, Value({}{{{}}}), {}}},\n", number,
                        cppString(field.name), one.major, one.minor, accessName(field.access),
                        writeRange(field.range), fieldTypeName(field.type),
                        cppInitializer(field.value), cppString(one.clause));
  });
  const std::string body = rows.empty()
                               ? "return {};"
                               : "constexpr double inf = std::numeric_limits<double>::infinity();\n"
                                 "  static const FieldRevision table[] = {\n" +
                                     rows + "  };\n  return table;";
  return "std::span<const FieldRevision> revisions() {\n  " + body + "\n}\n\n";
}

// Returns the table of the nodes that the library does not have.
std::string writeAbsent(const Model& model) {
  std::string rows;
  for (const Component& component : model.components)
    for (const AbsentNode& one : component.absent)
      rows += fmt::format("      {{{}, {}, {}, {}, {}}},\n", cppString(one.node.name),
                          cppString(one.origin), cppString(one.clause), cppString(one.kind),
                          cppString(one.loss));
  return tableFunction("AbsentNode", "absentNodes", rows);
}

} // namespace

std::string writeList(const Model& model) {
  std::string text = cppNotice();
  text += "// All node types, in the order of their typeIndex.\n#include <span>\n\n#include "
          "\"nodes/registry.h\"\n#include \"xvrml/nodes.h\"\n\n"
          "namespace xvrml::nodes {\n\n"
          "std::span<const NodeType* const> builtinNodeTypes() {\n  static const NodeType* const "
          "types[] = {\n";
  std::map<int, std::string> names; // by number
  eachNode(model, [&](const TypeSpec& type) { names.emplace(type.number, type.name); });
  for (const auto& [number, name] : names) text += fmt::format("      &{}::nodeType(),\n", name);
  return text + "  };\n  return types;\n}\n\n" + writeContainers(model) + writeLacks(model) +
         writeRevisions(model) + writeAbsent(model) + "} // namespace xvrml::nodes\n";
}

std::string writePlugin(const Model& model, const std::string& plugin) {
  std::string text = cppNotice(), declarations, rows;
  eachNode(model, [&](const TypeSpec& type) {
    declarations += fmt::format("NodePluginRow pluginRowOf{}();\n", type.name);
    rows += fmt::format("    pluginRowOf{}(),\n", type.name);
  });
  text += fmt::format(
      "// What the plug-in {0} exports.\n#include \"{0}_nodes.h\"\n\nnamespace xvrml::nodes "
      "{{\n{1}}} // namespace xvrml::nodes\n\nnamespace {{\nusing namespace xvrml::nodes;\n"
      "const xvrml::NodePluginRow rows[] = {{\n{2}}};\n}} // namespace\n\n",
      plugin, declarations, rows);
  return text +
         "XVRML_NODE_PLUGIN = {xvrml::nodePluginMagic,\n    xvrml::nodePluginMajor,\n    "
         "xvrml::nodePluginMinor,\n"
         "    sizeof(xvrml::NodePlugin),\n    XVRML_CXX_ABI,\n    {xvrml::nodePluginSizes[0], "
         "xvrml::nodePluginSizes[1], xvrml::nodePluginSizes[2], xvrml::nodePluginSizes[3],\n     "
         "xvrml::nodePluginSizes[4], xvrml::nodePluginSizes[5], xvrml::nodePluginSizes[6], "
         "xvrml::nodePluginSizes[7],\n     xvrml::nodePluginSizes[8], xvrml::nodePluginSizes[9]},\n"
         "    sizeof rows / sizeof rows[0],\n    rows};\n";
}

} // namespace xvrml::nodegen
