#include "edit/properties.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "edit/choices.h"
#include "edit/outline.h"
#include "edit/shader_parameters.h"
#include "xvrml/numbers.h"
#include "xvrml/value_text.h"
#include "xvrml/versions.h"
#include "xvrml/visit_storage.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr size_t mostUsable = 40; // nodes of the file that are offered

// Return the bytes of a text or a picture, or of all in a list; 0 for other values.
size_t bytesOf(const std::string& text) { return text.size(); }
size_t bytesOf(const Image& image) { return image.pixels.size(); }
template <class T> size_t bytesOf(const T& value) {
  size_t sum = 0;
  if constexpr (isList<T>)
    for (const auto& one : value) sum += bytesOf(one);
  return sum;
}

// A value is read where it stands, and not copied if it is long: it may have millions of elements.
// A node that is only read gets no block of rare fields.
void readValue(WorldEditor& editor, const Node& node, PropertyRow& row) {
  visitStorage(row.field->type, node.storage(*row.field), [&row](const auto& value) {
    using T = std::remove_cvref_t<decltype(value)>;
    const T* const byDefault = std::get_if<T>(&row.defaultValue);
    row.isDefault = byDefault && value == *byDefault;
    if constexpr (isList<T>) row.size = value.size();
    row.isLong =
        row.size > PropertySheet::mostElements || bytesOf(value) > PropertySheet::mostBytes;
    row.value = row.isLong ? Value() : Value(std::in_place_type<T>, value);
    row.shown = isList<T> ? row.value : Value();
  });
  row.edits = editor.editor().editsOf(node, row.field->name);
}

bool holdsNodes(const FieldInfo& field) {
  return field.type == FieldType::SFNode || field.type == FieldType::MFNode;
}

std::string helpOf(const FieldInfo& field, const std::string& text, const FieldRange& range) {
  std::string help =
      fmt::format("{} {} {}", accessName(field.access), fieldTypeName(field.type), field.name);
  if (!text.empty()) help += "\n" + text;
  if (range.bounded()) help += "\nrange " + xvrml::describe(range);
  return help;
}

PropertyRow rowOf(WorldEditor& editor, Node& node, const FieldInfo& field) {
  PropertyRow row;
  row.field = &field;
  row.defaultValue = defaultIn(node, field);
  row.range = rangeIn(node, field);
  row.help = helpOf(field, field.text, row.range);
  row.choices = choicesOf(field);
  row.isLinear = field.declared && node.type().is("shader");
  if (holdsNodes(field)) {
    row.addable = typesFor(field);
    row.usable = nodesFor(editor.browser().world(), field, mostUsable);
  }
  readValue(editor, node, row);
  return row;
}

// Adds the parameters of a shader's class that the node does not declare, and says of the others
// what the class says.
void addParameters(WorldEditor& editor, const nodes::ORTShader& shader, PropertySheet& sheet) {
  const picture::ShaderClass* const known = classOf(editor, shader.name, shader.file);
  if (!known) return;
  const std::map<std::string, ShaderOption> options = optionsOf(shader);
  for (const picture::ShaderParameter& parameter : known->parameters) {
    const std::optional<FieldInfo> field = fieldFor(parameter);
    if (!field) continue;
    const auto declared =
        std::find_if(sheet.rows.begin(), sheet.rows.end(),
                     [&](const PropertyRow& row) { return row.field->name == parameter.name; });
    if (declared != sheet.rows.end()) {
      if (!declared->field->declared) continue; // a field of the node itself has this name
      declared->help = helpOf(*declared->field, field->text, field->range);
      declared->range = field->range;
      if (declared->field->type != field->type) continue;
      declared->defaultValue = field->defaultValue;
      declared->isDefault = !declared->isLong && declared->value == declared->defaultValue;
      continue;
    }
    PropertyRow row;
    row.parameter = std::make_shared<const FieldInfo>(*field);
    row.field = row.parameter.get();
    row.value = row.defaultValue = field->defaultValue;
    row.range = field->range;
    row.help = helpOf(*field, field->text, field->range);
    row.isDefault = true;
    row.isDeclared = false;
    row.isLinear = true;
    if (const auto option = options.find(field->name); option != options.end()) {
      const std::optional<Value> set = valueOf(option->second, parameter);
      row.isInOptions = true;
      row.isLong = !set;
      if (set) row.value = *set;
      row.isDefault = row.value == row.defaultValue && set;
      row.help += "\nset by the options of the shader";
    }
    sheet.rows.push_back(std::move(row));
  }
}

// Returns in how many places of the file a node stands. Where nothing can be edited, or not yet,
// one is as good as any other, and nobody waits for it.
size_t placesOf(WorldEditor& editor, const NodeRef& node) {
  if (!node) return 0;
  const bool isEditable = !editor.editor().isPreparing() && editor.editor().whyReadOnly().empty();
  return isEditable ? editor.editor().countPlaces(*node) : 1;
}

std::string noteOf(const Node& node, size_t places) {
  std::string note;
  if (const auto* instance = nodeCast<ProtoInstance>(&node))
    note = fmt::format("an instance of PROTO {}: its body is edited by these fields",
                       instance->declaration->type->name);
  if (nodeCast<nodes::Inline>(&node))
    note = "its content belongs to another file, which is edited by itself";
  if (places == 0) return "not in the world's file: it belongs to an Inline, a PROTO or a Script";
  if (places > 1)
    note += fmt::format("{}stands in {} places: an edit changes all of them",
                        note.empty() ? "" : "; ", places);
  return note;
}

} // namespace

const PropertyRow* PropertySheet::find(const std::string& field) const {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const PropertyRow& row) { return row.field->name == field; });
  return found == rows.end() ? nullptr : &*found;
}

PropertySheet sheetOf(WorldEditor& editor, const NodeRef& node) {
  PropertySheet sheet;
  if (!node) return sheet;
  sheet.node = node;
  sheet.title = labelOf(*node);
  for (const FieldInfo& field : node->type().fields)
    if (holdsValue(field) && !field.isMetadata) sheet.rows.push_back(rowOf(editor, *node, field));
  if (const auto* const shader = nodeCast<nodes::ORTShader>(node))
    addParameters(editor, *shader, sheet);
  sheet.hasLook = nodeCast<nodes::Shape>(node) != nullptr;
  if (sheet.hasLook) {
    sheet.look = lookOf(*node);
    sheet.shaderOption = shaderOption(*node);
  }
  const auto places = [&editor](const NodeRef& one) { return placesOf(editor, one); };
  sheet.note = noteOf(*node, places(node));
  sheet.look.places = places(sheet.look.appearance);
  for (PropertyRow& row : sheet.rows) {
    if (const auto* const one = std::get_if<SFNode>(&row.value)) row.places = {places(*one)};
    if (const auto* const list = std::get_if<MFNode>(&row.value))
      for (const NodeRef& one : *list) row.places.push_back(places(one));
  }
  return sheet;
}

bool refresh(WorldEditor& editor, PropertySheet& sheet) {
  const bool isShader = nodeCast<nodes::ORTShader>(sheet.node) != nullptr;
  bool isSame = true;
  for (PropertyRow& row : sheet.rows) {
    if (!row.isDeclared) continue;
    const std::string& name = row.field->name;
    const bool isClass = isShader && (name == "name" || name == "file" || name == "options");
    const Value before = isClass ? row.value : Value();
    readValue(editor, *sheet.node, row);
    isSame &= !isClass || row.value == before;
  }
  // The name of the look may be a value of its shader.
  if (sheet.hasLook) {
    const size_t places = sheet.look.places;
    sheet.look = lookOf(*sheet.node);
    sheet.look.places = places;
    sheet.shaderOption = shaderOption(*sheet.node);
  }
  return isSame;
}

} // namespace vv
