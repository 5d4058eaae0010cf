// crossing.cpp: adapts urls, ranges and child nodes when a value passes into a prototype's body.
#include "graph/crossing.h"

#include <fmt/format.h>

#include "graph/field_access.h"
#include "graph/node_kinds.h"
#include "graph/range.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Returns whether the strings that pass are URLs. A Script gets the same URLs as the other nodes of
// the body that are connected to the field.
bool passesUrls(const IsAssignment& c) {
  return holdsUrls(c.node, c.to) ||
         (nodeCast<ScriptNode>(&c.node) && holdsUrls(c.instance, c.from));
}

// Returns whether `target` is a descendant of `top`, without the fields of Scripts and prototype
// instances. Called only where a node may be part of itself.
bool reaches(Node& top, const Node& target) {
  return !walk(std::vector<Node*>{&top}, [&](Node& node, std::vector<Node*>& open) {
    if (&node == &target) return false;
    if (node.type().index >= 0) appendChildren(node, open);
    const auto* instance = nodeCast<ProtoInstance>(&node);
    if (!instance) return true;
    appendRoots(instance->body, open);
    for (const IsConnection& connection : instance->is) open.push_back(connection.node.get());
    for (const Route& route : instance->body.routes) {
      open.push_back(route.from.get());
      open.push_back(route.to.get());
    }
    return true;
  });
}

// Returns whether the field accepts the node. Reports it if not.
bool acceptsNode(const IsAssignment& c, const NodeRef& child, Diagnostics& diagnostics) {
  if (!child) return true;
  if (c.checkCycles && c.node.type().index >= 0 && reaches(*child, c.node)) {
    diagnostics.error(
        c.instance.source,
        fmt::format("the value of {} would make a node its own descendant (4.4.4)", c.from.name));
    return false;
  }
  const NodeType* type = effectiveType(*child);
  if (!type || c.to.nodeTypes.empty() || typeAccepted(c.to.nodeTypes, *type)) return true;
  diagnostics.error(child->source,
                    fmt::format("'{}' cannot be in field {} of {} that {} stands for: expected {}",
                                type->name, c.to.name, c.node.type().name, c.from.name,
                                c.to.nodeTypes));
  return false;
}

} // namespace

void passUrls(const IsAssignment& c, MFString& urls) {
  if (nodeCast<ProtoInstance>(&c.node) || !passesUrls(c)) return;
  if (c.base && c.node.source.file) rebaseUrls(urls, *c.base, *c.node.source.file);
}

ReturnedUrls returnUrls(const Node& node, const FieldInfo& out, const ProtoInstance& instance,
                        const FieldInfo& to, const MFString& urls) {
  const bool areUrls = holdsUrls(node, out);
  const auto& base = urlBase(node, out);
  if (holdsValue(to)) {
    const auto& own = std::get<MFString>(instance.values[to.offset]);
    MFString passed = own;
    const auto& from = urlBase(instance, to);
    if (areUrls && from && base) rebaseUrls(passed, *from, *base);
    if (passed == urls) return {own, true};
  }
  ReturnedUrls result{urls, false};
  if (areUrls && base && instance.source.file)
    rebaseUrls(result.urls, *base, *instance.source.file);
  return result;
}

void assignUrlBase(Node& node, const FieldInfo& field, const Value& value) {
  auto* instance = nodeCast<ProtoInstance>(&node);
  if (!instance || field.type != FieldType::MFString || !holdsValue(field)) return;
  if (instance->values[field.offset] != value) instance->setUrlBase(field, nullptr);
}

void assignThroughIs(const IsAssignment& c, const Value& value, Diagnostics& diagnostics) {
  visitStorage(c.to.type, c.node.storage(c.to), [&](auto& target) {
    using T = std::remove_reference_t<decltype(target)>;
    target = std::get<T>(value);
    if constexpr (std::is_same_v<T, MFString>) {
      passUrls(c, target);
      if (auto* inner = nodeCast<ProtoInstance>(&c.node)) inner->setUrlBase(c.to, c.base);
    } else if constexpr (std::is_same_v<T, NodeRef>) {
      if (!acceptsNode(c, target, diagnostics)) target = {};
    } else if constexpr (std::is_same_v<T, MFNode>) {
      const bool keeps = keepsNull(c.node.type()) || c.node.type().index < 0;
      std::erase_if(target, [&](const NodeRef& child) {
        return child ? !acceptsNode(c, child, diagnostics) : !keeps;
      });
    }
  });
  if (!holdsNodes(c.to) && c.to.range.bounded())
    enforceRange(c.to, revisionOf(c.node.type(), c.to, versionOf(c.node)), c.node.storage(c.to));
}

} // namespace xvrml
