// urn.cpp: makes prototypes that wrap built-in nodes.
#include "parse/urn.h"

#include "graph/inline_node.h"
#include "graph/url.h"

namespace xvrml {

ProtoPtr builtinPrototype(std::string_view url, const ProtoDeclaration& declaration) {
  const NodeType& wanted = *declaration.type;
  const size_t first = std::min(url.find_first_not_of(" \t\r\n"), url.size());
  url = url.substr(first, url.find_last_not_of(" \t\r\n") + 1 - first);
  if (urlScheme(url) != "urn") return nullptr;
  const std::string_view name = url.substr(url.find_last_of(":#") + 1);
  const NodeType* type = findNodeType(name);
  if (!type || type->name == "Script") return nullptr;
  auto interface = std::make_shared<NodeType>();
  interface->name = wanted.name;
  interface->index = ProtoInstance::typeIndex;
  interface->create = nullptr;
  auto proto = std::make_shared<ProtoDeclaration>();
  proto->source = declaration.source;
  proto->baseUrl = declaration.baseUrl;
  const NodeRef node = makeStaticNode(*type);
  node->source = declaration.source;
  for (FieldInfo field : type->fields) {
    const FieldInfo* declared = wanted.find(field.name);
    if (declared && declared->type == field.type && field.access == Access::exposedField)
      field.access = declared->access;
    field.change = Change::none;
    field.holdsUrls = false; // the expander finds it, as for any prototype
    proto->is.push_back({node, field.name, field.name});
    addField(*interface, std::move(field));
  }
  proto->type = std::move(interface);
  proto->body.roots.push_back(node);
  return proto;
}

} // namespace xvrml
