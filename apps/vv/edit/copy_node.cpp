#include "edit/copy_node.h"

#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "edit/node_fields.h"

namespace vv {

using namespace xvrml;

namespace {

class Copier {
 public:
  explicit Copier(WorldEditor& editor) : editor_(editor) {}

  NodeRef copy(const NodeSlot& slot, const Node& node, int depth = 0) {
    constexpr int deepest = 32;
    if (const auto known = copies_.find(&node); known != copies_.end()) {
      editor_.editor().use(slot, *known->second);
      return known->second;
    }
    const NodeType& type = node.type();
    if (type.index < 0 || depth == deepest)
      throw EditError(type.index < 0
                          ? fmt::format("{} is declared in its own file: only built-in nodes can "
                                        "be copied from there",
                                        type.name)
                          : fmt::format("the nodes are nested deeper than {}", deepest));
    NodeRef made = insertNew(editor_, slot, type.name);
    // A declaration puts another node in the place, so it comes first.
    for (const FieldInfo& field : type.fields)
      if (holdsValue(field) && field.declared)
        made = editor_.editor().declare(*made, field.name, valueOf(node, field));
    copies_.emplace(&node, made);
    for (const FieldInfo& field : type.fields)
      if (holdsValue(field) && !field.declared && !field.isMetadata)
        copyField(node, field, *made, depth);
    return made;
  }

 private:
  void copyField(const Node& node, const FieldInfo& field, Node& made, int depth) {
    if (field.type == FieldType::SFNode) {
      if (const NodeRef& child = *static_cast<const SFNode*>(node.storage(field)))
        copy({&made, field.name, 0}, *child, depth + 1);
    } else if (field.type == FieldType::MFNode) {
      size_t index = 0;
      for (const NodeRef& child : *static_cast<const MFNode*>(node.storage(field)))
        if (child) copy({&made, field.name, index++}, *child, depth + 1);
    } else if (Value value = valueOf(node, field); value != field.defaultValue) {
      editor_.editor().set(made, field.name, std::move(value));
    }
  }

  // Returns the value of a field, with URLs that count from the edited file.
  Value valueOf(const Node& node, const FieldInfo& field) const {
    Value value = node.get(field);
    if (field.holdsUrls && node.source.file)
      rebaseUrls(std::get<MFString>(value), *node.source.file, editor_.browser().world().path);
    return value;
  }

  WorldEditor& editor_;
  std::unordered_map<const Node*, NodeRef> copies_;
};

} // namespace

NodeRef copyNode(WorldEditor& editor, const NodeSlot& slot, const NodeRef& node) {
  return Copier(editor).copy(slot, *node);
}

} // namespace vv
