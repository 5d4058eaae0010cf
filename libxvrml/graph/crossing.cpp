// crossing.cpp: adapts urls, ranges and child nodes when a value passes into a prototype's body.
#include "graph/crossing.h"

#include <filesystem>

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
         (dynamic_cast<const ScriptNode*>(&c.node) && holdsUrls(c.instance, c.from));
}

// Converts relative URLs written in the instance's file for a node that is in another file (4.5.3).
void rebaseUrls(MFString& urls, const std::string& from, const std::string& to) {
  namespace fs = std::filesystem;
  const fs::path fromFolder = fs::path(from).lexically_normal().parent_path();
  const fs::path toFolder = fs::path(to).lexically_normal().parent_path();
  if (fromFolder == toFolder) return;
  const fs::path step = fromFolder.lexically_relative(toFolder);
  if (step.empty() || step == ".") return;
  for (std::string& url : urls) {
    const size_t colon = url.find(':');
    const bool relative = !url.empty() && url[0] != '/' && url[0] != '#' &&
                          (colon == url.npos || url.find('/') < colon);
    if (relative) url = (step / url).string();
  }
}

// Returns whether `target` is a descendant of `top`, without the fields of Scripts and prototype
// instances. Called only where a node may be part of itself.
bool reaches(Node& top, const Node& target) {
  return !walk(std::vector<Node*>{&top}, [&](Node& node, std::vector<Node*>& open) {
    if (&node == &target) return false;
    if (node.type().index >= 0) appendChildren(node, open);
    const auto* instance = dynamic_cast<const ProtoInstance*>(&node);
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

void assignThroughIs(const IsAssignment& c, const Value& value, Diagnostics& diagnostics) {
  visitStorage(c.to.type, c.node.storage(c.to), [&](auto& target) {
    using T = std::remove_reference_t<decltype(target)>;
    target = std::get<T>(value);
    if constexpr (std::is_same_v<T, MFString>) {
      const bool foreign = c.given && c.instance.source.file && c.node.source.file;
      if (foreign && passesUrls(c))
        rebaseUrls(target, *c.instance.source.file, *c.node.source.file);
    } else if constexpr (std::is_same_v<T, NodeRef>) {
      if (!acceptsNode(c, target, diagnostics)) target = {};
    } else if constexpr (std::is_same_v<T, MFNode>) {
      const bool keeps = keepsNull(c.node.type()) || c.node.type().index < 0;
      std::erase_if(target, [&](const NodeRef& child) {
        return child ? !acceptsNode(c, child, diagnostics) : !keeps;
      });
    }
  });
  if (!holdsNodes(c.to) && c.to.range.bounded()) enforceRange(c.to, c.node.storage(c.to));
}

} // namespace xvrml
