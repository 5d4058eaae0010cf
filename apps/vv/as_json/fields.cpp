#include "as_json/fields.h"

#include <fmt/format.h>

#include "as_json/members.h"
#include "xvrml/versions.h"

namespace vv::json {

using namespace xvrml;

bool isReadable(const FieldInfo& field) { return field.access != Access::eventIn; }
bool isWritable(const FieldInfo& field) { return field.access != Access::eventOut; }
bool sends(const FieldInfo& field) {
  return field.access == Access::eventOut || field.access == Access::exposedField;
}

std::vector<std::string> fieldNames(const Node& node, bool (*test)(const FieldInfo& field)) {
  std::vector<std::string> names;
  for (const FieldInfo& field : node.type().fields)
    if (test(field)) names.emplace_back(fieldName(node, field));
  return names;
}

void refuseField(const Node& node, const std::string& name, const char* use,
                 const std::vector<std::string>& known) {
  const std::string& type = node.type().name;
  if (const FieldInfo* field = findField(node, name))
    throw CommandError("field", fmt::format("{}.{} is an {}: it cannot be {}", type, name,
                                            accessName(field->access), use));
  throw CommandError("field", fmt::format("{} has no field or event {}{}", type, jsonText(name),
                                          nearTo(name, known)));
}

const FieldInfo& readableField(const Node& node, const std::string& name) {
  const FieldInfo* field = findField(node, name);
  if (!field || !isReadable(*field)) field = findEventOut(node, name);
  if (!field) refuseField(node, name, "read", fieldNames(node, isReadable));
  return *field;
}

const FieldInfo& writableField(const Node& node, const std::string& name) {
  const FieldInfo* field = findField(node, name);
  if (!field || field->access != Access::field) field = findEventIn(node, name);
  if (!field) refuseField(node, name, "set", fieldNames(node, isWritable));
  return *field;
}

const FieldInfo& storedField(const Node& node, const std::string& name) {
  const FieldInfo* field = findField(node, name);
  if (!field || !holdsValue(*field))
    refuseField(node, name, "edited", fieldNames(node, holdsValue));
  return *field;
}

} // namespace vv::json
