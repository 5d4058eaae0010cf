#include "xvrml/versions.h"

#include <algorithm>
#include <utility>

#include "base/x3d.h"
#include "nodes/registry.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// Returns whether the names of a node's fields may be others in its file than ours.
bool isRespelled(const Node& node) { return node.type().index >= 0 && versionOf(node).isX3d(); }

// Returns the field if events may change it in the version of the node's file.
const FieldInfo* ifEvent(const Node& node, const FieldInfo* field) {
  return field && field->exposedSince > versionOf(node).major ? nullptr : field;
}

} // namespace

std::string_view ownName(const Node& node, std::string_view name) {
  return isRespelled(node) ? ownName(node.type().name, name) : name;
}

std::string_view fieldName(const Node& node, const FieldInfo& field) {
  return isRespelled(node) ? x3dName(node.type().name, field.name, versionOf(node).major)
                           : std::string_view(field.name);
}

std::string_view otherFieldName(const Node& node, const FieldInfo& field) {
  if (node.type().index < 0) return {};
  const std::string_view own = field.name;
  if (fieldName(node, field) != own) return own;
  constexpr int newest = 4;
  const std::string_view other = x3dName(node.type().name, own, newest);
  return other == own ? std::string_view() : other;
}

const FieldInfo* findField(const Node& node, std::string_view name) {
  return node.type().find(ownName(node, name));
}
const FieldInfo* findEventIn(const Node& node, std::string_view name) {
  return ifEvent(node, node.type().findEventIn(ownName(node, name)));
}
const FieldInfo* findEventOut(const Node& node, std::string_view name) {
  return ifEvent(node, node.type().findEventOut(ownName(node, name)));
}

std::span<const FieldRevision> revisionsOf(const NodeType& type) {
  if (type.index < 0) return {};
  const auto rows =
      std::ranges::equal_range(nodes::revisions(), type.index, {}, &FieldRevision::type);
  return {rows.begin(), rows.end()};
}

const FieldRevision* revisionOf(const NodeType& type, const FieldInfo& field,
                                const FileVersion& version) {
  const FieldRevision* found = nullptr; // the last one counts
  if (version.isX3d())
    for (const FieldRevision& one : revisionsOf(type))
      if (std::pair(one.major, one.minor) <= std::pair(version.major, version.minor) &&
          one.field == field.name)
        found = &one;
  return found;
}

const Value& defaultIn(const NodeType& type, const FieldInfo& field, const FileVersion& version) {
  const FieldRevision* const revision = revisionOf(type, field, version);
  return revision ? revision->defaultValue : field.defaultValue;
}

const FieldRange& rangeIn(const Node& node, const FieldInfo& field) {
  const FieldRevision* const revision = revisionOf(node.type(), field, versionOf(node));
  return revision ? revision->range : field.range;
}

const Value& defaultIn(const Node& node, const FieldInfo& field) {
  return defaultIn(node.type(), field, versionOf(node));
}

bool inRange(const Node& node, const FieldInfo& field, const Value& value) {
  FieldInfo revised;
  revised.type = field.type;
  revised.range = rangeIn(node, field);
  return inRange(revised, value);
}

} // namespace xvrml
