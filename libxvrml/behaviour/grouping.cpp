// grouping.cpp: addChildren and removeChildren of all grouping nodes (clause 4.6.5), and of LOD and
// Switch (ISO/IEC 19775-1 23.4.3 and 10.4.4); the same of NURBS (27.4.1, 27.4.9, 27.4.14).
#include <algorithm>

#include "behaviour/builtin.h"
#include "behaviour/lod.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// Returns the field that holds the children.
const FieldInfo& listOf(const Node& node) {
  if (nodeCast<nodes::LOD>(&node)) return *fieldNamed<"level">(node);
  if (nodeCast<nodes::NurbsSet>(&node)) return *fieldNamed<"geometry">(node);
  if (nodeCast<nodes::NurbsTrimmedSurface>(&node)) return *fieldNamed<"trimmingContour">(node);
  return nodeCast<nodes::Switch>(&node) ? *fieldNamed<"choice">(node)
                                        : *fieldNamed<"children">(node);
}

// Adds or removes children. children is an exposedField, so a change sends children_changed. Adding
// a present child or removing an absent one has no effect and sends no event.
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  const bool adds = in.name.starts_with("add");
  if (in.access != Access::eventIn || (!adds && !in.name.starts_with("remove"))) return;
  const FieldInfo& children = listOf(node);
  auto list = std::get<MFNode>(node.get(children));
  const MFNode before = list;
  const auto holds = [&](const NodeRef& child) {
    return std::find(list.begin(), list.end(), child) != list.end();
  };
  const auto& named = std::get<MFNode>(value);
  if (adds) {
    for (const NodeRef& child : named)
      if (child && !holds(child)) list.push_back(child);
  } else {
    std::erase_if(list, [&](const NodeRef& child) {
      return std::find(named.begin(), named.end(), child) != named.end();
    });
  }
  if (!events.store(node, children, std::move(list))) return;
  const Value now = node.get(children); // nodes that are no valid children have been left out
  if (now != Value(before)) events.send(node, children, now);
}

} // namespace

void addGroupingBehaviours(const AddBehaviour& add) {
  for (const NodeType* type : nodeTypes())
    if (type->find("addChildren")) add(*type, {.receive = receive});
  add(nodes::NurbsSet::nodeType(), {.receive = receive});
  add(nodes::NurbsTrimmedSurface::nodeType(), {.receive = receive});
  add(nodes::LOD::nodeType(), {.begin = beginLod, .receive = receive, .look = lookLod});
}

} // namespace xvrml
