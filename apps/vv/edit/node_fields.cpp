#include "edit/node_fields.h"

#include <algorithm>

#include <fmt/format.h>

namespace vv {

using namespace xvrml;

namespace {

constexpr size_t mostNames = 1000; // names of the file that are looked at

bool accepts(const FieldInfo& field, const NodeType& type) {
  if (field.nodeTypes.empty()) return true;
  std::string_view names = field.nodeTypes;
  while (!names.empty()) {
    const size_t end = std::min(names.find(' '), names.size());
    const std::string_view name = names.substr(0, end);
    if (!name.empty() && (type.name == name || type.is(name))) return true;
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return false;
}

// Returns the field of a place; null: the node is a root of the file. Throws EditError if the
// parent has no such field of nodes.
const FieldInfo* fieldOf(const PlacedNode& place) {
  if (!place.parent) return nullptr;
  const FieldInfo* const field = place.parent->type().find(place.field);
  const bool holdsNodes = field && holdsValue(*field) &&
                          (field->type == FieldType::SFNode || field->type == FieldType::MFNode);
  if (!holdsNodes)
    throw EditError(
        fmt::format("{} has no field {} that holds nodes", place.parent->type().name, place.field));
  return field;
}

const MFNode& listAt(WorldEditor& editor, const PlacedNode& place) {
  const FieldInfo* const field = fieldOf(place);
  return field ? *static_cast<const MFNode*>(place.parent->storage(*field))
               : editor.browser().world().scope.roots;
}

bool isInList(const PlacedNode& place) {
  const FieldInfo* const field = fieldOf(place);
  return !field || field->type == FieldType::MFNode;
}

// Returns the place for the editor. Throws EditError if another edit has moved the node.
NodeSlot slotOf(WorldEditor& editor, const PlacedNode& place) {
  const NodeSlot slot{place.parent.get(), place.field, place.index};
  bool stands = false;
  if (!isInList(place)) {
    stands = *static_cast<const SFNode*>(place.parent->storage(*fieldOf(place))) == place.node;
  } else {
    const MFNode& list = listAt(editor, place);
    stands = place.index < list.size() && list[place.index] == place.node;
  }
  if (!stands)
    throw EditError(
        fmt::format("this {} has been moved or removed meanwhile", place.node->type().name));
  return slot;
}

} // namespace

std::vector<const NodeType*> typesFor(const FieldInfo& field) {
  std::vector<const NodeType*> types;
  for (const NodeType* type : nodeTypes())
    if (accepts(field, *type)) types.push_back(type);
  std::sort(types.begin(), types.end(),
            [](const NodeType* a, const NodeType* b) { return a->name < b->name; });
  return types;
}

std::vector<NodeRef> nodesFor(const World& world, const FieldInfo& field, size_t most) {
  std::vector<NodeRef> nodes;
  size_t seen = 0;
  for (const auto& [name, node] : world.scope.names) {
    if (nodes.size() == most || seen++ == mostNames) break;
    const Node* const rendered = renderedNode(node.get());
    if (rendered && accepts(field, rendered->type())) nodes.push_back(node);
  }
  return nodes;
}

NodeRef insertNew(WorldEditor& editor, const NodeSlot& slot, const std::string& type) {
  const char* form = "{} {{ }}";
  switch (editor.browser().world().head.version.encoding) {
  case Encoding::x3dXml: form = "<{}/>"; break;
  case Encoding::x3dJson: form = "{{ \"{}\": {{ }} }}"; break;
  default: break;
  }
  return editor.editor().insert(slot, fmt::format(fmt::runtime(form), type));
}

void addNode(WorldEditor& editor, const NodeRef& parent, const std::string& field,
             const NodeType& type) {
  insertNew(editor, editor.endOf(parent.get(), field), type.name);
}

void useNode(WorldEditor& editor, const NodeRef& parent, const std::string& field,
             const NodeRef& node) {
  editor.editor().use(editor.endOf(parent.get(), field), *node);
}

void removeAt(WorldEditor& editor, const PlacedNode& place) {
  editor.editor().remove(slotOf(editor, place));
  MFNode rest = editor.selection();
  if (!editor.editor().stands(*place.node)) std::erase(rest, place.node);
  editor.select(std::move(rest));
}

void moveBy(WorldEditor& editor, const PlacedNode& place, int by) {
  const NodeSlot from = slotOf(editor, place);
  if (!isInList(place)) return;
  const size_t last = listAt(editor, place).size() - 1;
  const auto to = std::ptrdiff_t(from.index) + by;
  if (to < 0 || size_t(to) > last) return;
  editor.editor().move(from, {from.parent, from.field, size_t(to)});
}

void separateAt(WorldEditor& editor, const PlacedNode& place) {
  const NodeRef copy = editor.editor().separate(slotOf(editor, place));
  MFNode nodes = editor.selection();
  std::replace(nodes.begin(), nodes.end(), place.node, copy);
  editor.select(std::move(nodes));
}

} // namespace vv
