// inline_node.cpp: makes built-in nodes, types that nodes have of their own, and the content of
// Inlines.
#include "graph/inline_node.h"

#include "base/deformable.h"
#include "base/particle_clock.h"
#include "graph/field_access.h"

namespace xvrml {

NodeRef makeStaticNode(const NodeType& type) {
  switch (type.index) {
  case nodes::Inline::typeIndex: return NodeRef(new InlineNode());
  case nodes::Coordinate::typeIndex: return NodeRef(new DeformableCoordinate());
  case nodes::CoordinateDouble::typeIndex: return NodeRef(new DeformableCoordinateDouble());
  case nodes::Normal::typeIndex: return NodeRef(new DeformableNormal());
  case nodes::ParticleSystem::typeIndex: return NodeRef(new TimedParticleSystem());
  default: return NodeRef(type.create(type));
  }
}

NodeRef makeLike(const Node& staticNode) {
  const NodeType& type = staticNode.type();
  if (type.create) return makeStaticNode(type);
  NodeRef made = makeStaticNode(*nodeTypes()[size_t(type.index)]);
  const auto& own = static_cast<const DeclaringNode&>(staticNode);
  auto& copy = static_cast<DeclaringNode&>(*made);
  copy.setOwnType(own.ownType());
  copy.places = own.places;
  return made;
}

// A static node has the values of its built-in fields in its struct.
const FieldInfo& addField(NodeType& type, FieldInfo field) {
  uint32_t offset = 0;
  for (const FieldInfo& other : type.fields)
    offset += holdsValue(other) && (type.index < 0 || other.declared);
  field.sets = -1; // the field may be that of a static type
  field.rare = nullptr;
  field.offset = offset;
  return type.fields.emplace_back(std::move(field));
}

// Scripts have all their values in a list.
static std::shared_ptr<NodeType> scriptType(const NodeType& script) {
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

std::shared_ptr<NodeType> makeOwnType(const NodeType& type) {
  if (type.index == nodes::Script::typeIndex) return scriptType(type);
  auto own = std::make_shared<NodeType>(type);
  own->create = nullptr;
  return own;
}

std::vector<Value>& declaredValues(Node& node) {
  auto* script = nodeCast<ScriptNode>(&node);
  return script ? script->values : static_cast<DeclaringNode&>(node).values;
}

const Scope* inlineScope(const Node& inlineNode) {
  const auto* node = nodeCast<InlineNode>(&inlineNode);
  return node ? node->content.get() : nullptr;
}

} // namespace xvrml
