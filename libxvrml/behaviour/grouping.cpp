// grouping.cpp: addChildren and removeChildren of all grouping nodes (clause 4.6.5).
#include <algorithm>

#include "behaviour/builtin.h"

namespace xvrml {
namespace {

// children is an exposedField: what changes it sends children_changed. What is there already is not
// added again; what is not there cannot be removed. Both make no event.
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  const bool adds = in.name == "addChildren";
  if (!adds && in.name != "removeChildren") return;
  const FieldInfo& children = *node.type().find("children");
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
  const Value now = node.get(children); // a node that cannot be a child has been left out
  if (now != Value(before)) events.send(node, children, now);
}

} // namespace

void addGroupingBehaviours(const AddBehaviour& add) {
  for (const NodeType* type : nodeTypes())
    if (type->is("parent")) add(*type, {.receive = receive});
}

} // namespace xvrml
