// node_list.cpp: prints node types from their tables.
#include "node_list.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "describe.h"
#include "printable.h"
#include "xvrml/versions.h"

namespace vv {

namespace {

using Json = nlohmann::ordered_json;

// Returns what versions of X3D say otherwise of a field.
Json versionsJson(const xvrml::NodeType& type, const xvrml::FieldInfo& field) {
  Json all = Json::array();
  for (const xvrml::FieldRevision& one : revisionsOf(type))
    if (one.field == field.name)
      all.push_back({{"since", fmt::format("{}.{}", one.major, one.minor)},
                     {"access", accessName(one.access)},
                     {"default", valueText(one.defaultValue)},
                     {"clause", std::string(one.clause)}});
  return all;
}

// Returns the access of a field in VRML97, or in the standard that adds it.
std::string_view ownAccess(const xvrml::FieldInfo& field) {
  return accessName(field.exposedSince ? xvrml::Access::field : field.access);
}

Json typeJson(const xvrml::NodeType& type) {
  Json fields = Json::array();
  for (const xvrml::FieldInfo& field : type.fields) {
    Json one = {
        {"name", field.name}, {"type", fieldTypeName(field.type)}, {"access", ownAccess(field)}};
    if (holdsValue(field)) one["default"] = valueText(field.defaultValue);
    if (!field.nodeTypes.empty()) one["accepts"] = field.nodeTypes;
    if (!field.text.empty()) one["text"] = field.text;
    if (field.ofX3d) one["standard"] = standardName(xvrml::Standard::x3d);
    if (Json versions = versionsJson(type, field); !versions.empty())
      one["versions"] = std::move(versions);
    fields.push_back(std::move(one));
  }
  Json all = {{"name", type.name}, {"component", type.component}, {"text", type.text}};
  if (type.standard != xvrml::Standard::none) {
    all["standard"] = standardName(type.standard);
    all["clause"] = type.clause;
  }
  all["fields"] = std::move(fields);
  return all;
}

std::string typeText(const xvrml::NodeType& type, std::string_view comment) {
  std::string out = fmt::format("{} {{{}{}", type.name, comment.empty() ? "" : " # ", comment);
  if (type.standard != xvrml::Standard::none)
    out += fmt::format(" {} clause {}.", standardName(type.standard), type.clause);
  out += '\n';
  for (const xvrml::FieldInfo& field : type.fields) {
    std::string line =
        fmt::format("  {:<12} {:<10} {}", ownAccess(field), fieldTypeName(field.type), field.name);
    if (holdsValue(field)) line = fmt::format("{:<46} {}", line, valueText(field.defaultValue));
    if (field.ofX3d) line += "  # X3D";
    out += line + "\n";
  }
  return out + "}\n";
}

} // namespace

std::string listNodes(const xvrml::World* world, bool json) {
  Json list = Json::array(), prototypes = Json::array();
  std::string text;
  for (const xvrml::NodeType* type : xvrml::nodeTypes()) {
    if (json)
      list.push_back(typeJson(*type));
    else
      text += typeText(*type, type->text);
  }
  if (world) {
    for (const xvrml::ProtoPtr& prototype : world->scope.prototypes) {
      if (json)
        prototypes.push_back(typeJson(*prototype->type));
      else
        text += typeText(*prototype->type, prototype->isExtern ? "EXTERNPROTO of " + world->path
                                                               : "PROTO of " + world->path);
    }
  }
  if (!json) return text;
  Json all = {{"nodes", std::move(list)}};
  if (world) all["prototypes"] = std::move(prototypes);
  return printableJson(all.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

} // namespace vv
