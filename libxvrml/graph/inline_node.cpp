// inline_node.cpp: built-in nodes, Script types, and the content of Inlines.
#include "graph/inline_node.h"

#include "graph/field_access.h"

namespace xvrml {

NodeRef makeStaticNode(const NodeType& type) {
  return NodeRef(type.index == nodes::Inline::typeIndex ? new InlineNode() : type.create(type));
}

const FieldInfo& addField(NodeType& type, FieldInfo field) {
  uint32_t offset = 0;
  for (const FieldInfo& other : type.fields) offset += holdsValue(other);
  field.sets = -1; // the field may be that of a static type
  field.offset = offset;
  return type.fields.emplace_back(std::move(field));
}

std::shared_ptr<NodeType> scriptType(const NodeType& script) {
  auto type = std::make_shared<NodeType>();
  type->name = script.name;
  type->index = ScriptNode::typeIndex;
  type->abstract = script.abstract;
  type->component = script.component;
  type->text = script.text;
  type->create = nullptr;
  for (const FieldInfo& field : script.fields) addField(*type, field);
  return type;
}

const Scope* inlineScope(const Node& inlineNode) {
  const auto* node = nodeCast<InlineNode>(&inlineNode);
  return node ? node->content.get() : nullptr;
}

} // namespace xvrml
