#include "server/edit_nodes.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "as_json/fields.h"
#include "as_json/perform_step.h"
#include "edit/actions.h"
#include "edit/looks.h"
#include "edit/node_fields.h"
#include "server/edit_texts.h"
#include "xvrml/numbers.h"

namespace vv::server {

using namespace xvrml;
using json::CommandError;

namespace {

NodeRef namedNode(const json::NodeNumbers& numbers, const json::NodeName& name) {
  if (const auto* number = std::get_if<uint64_t>(&name)) return nodeOf(numbers, *number);
  throw CommandError("node", "a page names nodes by their numbers");
}

PlacedNode placedNode(const json::NodeNumbers& numbers, const edit::At& at) {
  return {nodeOf(numbers, at.node), at.parent ? nodeOf(numbers, *at.parent) : NodeRef(), at.field,
          at.index};
}

// Does one edit for each kind of command.
struct Performer {
  WorldEditor& editor;
  EditModel& model;
  const json::NodeNumbers& numbers;
  const EditView& view;
  const FindLook& findLook;

  void operator()(const edit::Reset& reset) const {
    const NodeRef node = nodeOf(numbers, reset.node);
    const FieldInfo& field = valueField(*node, reset.field);
    // A parameter of a shader has the default of its class.
    const PropertySheet& sheet = model.sheet();
    const PropertyRow* const row = sheet.node == node ? sheet.find(field.name) : nullptr;
    const Value value = row ? row->defaultValue : field.defaultValue;
    editor.step(fmt::format("Reset {}.{}", node->type().name, field.name),
                [&] { editor.editor().set(*node, field.name, value); });
  }

  void operator()(const edit::Step& step) const {
    MFNode made;
    editor.step(step.name, [&] {
      made = json::edits::perform(
          step, editor, [this](const json::NodeName& name) { return namedNode(numbers, name); });
    });
    std::erase(made, NodeRef());
    if (!made.empty()) editor.select(std::move(made));
  }

  void operator()(const edit::Add& add) const {
    if (add.kind == edit::viewpointKind) return addViewpoint(editor, view);
    const auto kinds = newNodes();
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const NewNode& one) { return add.kind == one.name; });
    if (kind == kinds.end()) throw EditError("there is no such node to be added");
    vv::add(editor, *kind);
  }

  void operator()(const edit::Duplicate&) const { duplicateSelected(editor); }
  void operator()(const edit::Remove&) const { removeSelected(editor); }
  void operator()(const edit::Wrap&) const { wrapSelected(editor); }

  void operator()(const edit::AddNode& add) const {
    const NodeRef parent = nodeOf(numbers, add.node);
    const NodeType* const type = findNodeType(add.kind);
    if (!type) throw EditError(fmt::format("there is no type of nodes {}", add.kind));
    addNode(editor, parent, add.field, *type);
  }

  void operator()(const edit::UseNode& use) const {
    useNode(editor, nodeOf(numbers, use.node), use.field, nodeOf(numbers, use.used));
  }

  void operator()(const edit::RemoveAt& remove) const {
    removeAt(editor, placedNode(numbers, remove.at));
  }
  void operator()(const edit::MoveAt& move) const {
    moveBy(editor, placedNode(numbers, move.at), move.by);
  }
  void operator()(const edit::SeparateAt& separate) const {
    separateAt(editor, placedNode(numbers, separate.at));
  }

  void operator()(const edit::SetLook& look) const {
    setLook(editor, findLook(look.number), look.onlyHere);
  }
};

} // namespace

NodeRef nodeOf(const json::NodeNumbers& numbers, uint64_t number) {
  NodeRef node = numbers.find(number);
  if (!node) throw CommandError("node", "this node is not shown any more: choose it again");
  return node;
}

const FieldInfo& valueField(const Node& node, const std::string& name) {
  const FieldInfo& field = json::storedField(node, name);
  if (field.type == FieldType::SFNode || field.type == FieldType::MFNode)
    throw EditError(
        fmt::format("{}.{} holds nodes: insert or remove them", node.type().name, field.name));
  return field;
}

Value draggedValue(const edit::Drag& drag, const Node& node, const FieldInfo& field,
                   const Value& now) {
  if (!drag.element) return json::readValue(drag.value, node, field, {});
  const size_t index = drag.element->index, size = drag.element->size;
  const std::string what = fmt::format("{}.{}", node.type().name, field.name);
  const bool isRemoved = drag.value.is_null();
  if (size > PropertySheet::mostElements || index >= size + (isRemoved ? 0 : 1))
    throw CommandError("value", fmt::format("{} has no such element", what));
  Value value = now;
  std::visit(
      [&](auto& list) {
        using List = std::remove_cvref_t<decltype(list)>;
        if constexpr (isList<List>) {
          if (list.size() != size)
            throw EditError(fmt::format("{} has {} elements now: choose again", what, list.size()));
          const auto at = list.begin() + std::ptrdiff_t(index);
          if (isRemoved) {
            list.erase(at);
            return;
          }
          const Value read = json::readValue(json::Json::array({drag.value}), node, field, {});
          const List& single = std::get<List>(read);
          if (single.size() != 1)
            throw CommandError("value", fmt::format("{}: one element was expected", what));
          if (index == size)
            list.push_back(single[0]);
          else
            list[index] = single[0];
        } else {
          throw CommandError("value", fmt::format("{} is no list", what));
        }
      },
      value);
  return value;
}

void perform(const edit::NodeCommand& command, WorldEditor& editor, EditModel& model,
             const json::NodeNumbers& numbers, const EditView& view, const FindLook& findLook) {
  std::visit(Performer{editor, model, numbers, view, findLook}, command);
}

} // namespace vv::server
