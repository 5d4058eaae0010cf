// named_fields.h: fields and events by name, for behaviours, which need them at every event and for
// nodes of several types. A name is looked up once for each type. [any thread]
#pragma once

#include <algorithm>
#include <cstddef>

#include "xvrml/behaviour.h"

namespace xvrml {

// The rows of the fields of one name, by NodeType::index.
class FieldsByType {
 public:
  explicit FieldsByType(std::string_view name) : name_(name) {
    for (const NodeType* type : nodeTypes()) fields_.push_back(type->find(name));
  }
  const FieldInfo* of(const NodeType& type) const {
    const auto index = size_t(type.index);
    // Plug-ins may have been loaded since.
    return index < fields_.size() ? fields_[index] : type.find(name_);
  }

 private:
  std::string_view name_;
  std::vector<const FieldInfo*> fields_;
};

// A string that can be the argument of a template.
template <size_t size> struct FieldName {
  constexpr FieldName(const char (&text)[size]) { std::copy_n(text, size, this->text); }
  char text[size];
};

// Returns the row of the node's field, eventIn or eventOut of a name: fieldNamed<"enabled">(node).
// Null if its type has none.
template <FieldName name> const FieldInfo* fieldNamed(const Node& node) {
  static const FieldsByType all(name.text);
  return all.of(node.type());
}

// Returns whether the field of the node has the name.
template <FieldName name> bool isField(const Node& node, const FieldInfo& field) {
  return &field == fieldNamed<name>(node);
}

// Sends an event from the eventOut or exposedField of a name. Does nothing if the node has none.
template <FieldName name> void sendFrom(Events& events, Node& node, Value value) {
  if (const FieldInfo* out = fieldNamed<name>(node)) events.send(node, *out, std::move(value));
}

} // namespace xvrml
