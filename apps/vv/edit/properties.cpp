#include "edit/properties.h"

#include <type_traits>

#include <fmt/format.h>

#include "edit/outline.h"
#include "xvrml/numbers.h"

namespace vv {

using namespace xvrml;

namespace {

size_t sizeOf(const Value& value) {
  return std::visit(
      [](const auto& one) -> size_t {
        if constexpr (isList<std::remove_cvref_t<decltype(one)>>)
          return one.size();
        else
          return 0;
      },
      value);
}

PropertyRow rowOf(const Node& node, const FieldInfo& field) {
  PropertyRow row;
  row.field = &field;
  row.value = node.get(field);
  row.size = sizeOf(row.value);
  row.isDefault = row.value == field.defaultValue;
  row.isLong = row.size > PropertySheet::mostElements;
  if (row.isLong) row.value = Value();
  return row;
}

std::string noteOf(WorldEditor& editor, const Node& node) {
  std::string note;
  if (const auto* instance = nodeCast<ProtoInstance>(&node))
    note = fmt::format("an instance of PROTO {}: its body is edited by these fields",
                       instance->declaration->type->name);
  const size_t places = editor.editor().placesOf(node).size();
  if (places == 0) return "not in the world's file: it belongs to an Inline, a PROTO or a Script";
  if (places > 1)
    note += fmt::format("{}stands in {} places: an edit changes all of them",
                        note.empty() ? "" : "; ", places);
  return note;
}

} // namespace

PropertySheet sheetOf(WorldEditor& editor, const NodeRef& node) {
  PropertySheet sheet;
  if (!node) return sheet;
  sheet.node = node;
  sheet.title = labelOf(*node);
  sheet.note = noteOf(editor, *node);
  for (const FieldInfo& field : node->type().fields)
    if (holdsValue(field) && !field.isMetadata) sheet.rows.push_back(rowOf(*node, field));
  return sheet;
}

void refresh(PropertySheet& sheet) {
  for (PropertyRow& row : sheet.rows) row = rowOf(*sheet.node, *row.field);
}

} // namespace vv
