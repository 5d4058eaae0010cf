// binding.cpp: the bindable stacks. Rule letters are those of clause 4.6.10 and, for Viewpoints, of
// 6.53.
#include "behaviour/viewer/binding.h"

#include <algorithm>

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "graph/field_access.h"
#include "nodes/bindable.h"
#include "nodes/viewpoint.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace xvrml {

size_t Binding::typeOf(const Node& node) { return size_t(bindableStack(node.type())); }

void Binding::sendBindEvents(Node& node, bool bound) {
  sendFrom<"isBound">(engine_, node, bound);
  sendFrom<"bindTime">(engine_, node, engine_.now());
  engine_.changed(node, *fieldNamed<"set_bind">(node));
  // The NavigationInfo of a viewpoint is bound and unbound with it (ISO/IEC 19775-1:2023 23.3.1).
  if (const auto viewpoint = viewpointFields(&node))
    if (Node* info = renderedNode(viewpoint->navigationInfo))
      if (const FieldInfo* bind = fieldNamed<"set_bind">(*info)) engine_.post(*info, *bind, bound);
}

// Rules a and b: sends isBound FALSE of the old node, then isBound TRUE of the new node, at the
// same time.
void Binding::push(size_t type, Node& node) {
  Stack& stack = stacks_[type];
  NodeRef old(top(type));
  std::erase_if(stack, [&](const Entry& e) { return e.node.get() == &node; });
  stack.push_back({NodeRef(&node), isInScene(node)});
  if (type == viewpointStack) viewer_.bind(old.get(), &node);
  if (old) sendBindEvents(*old, false);
  sendBindEvents(node, true);
}

// Rule c. A node below the top leaves without events.
void Binding::remove(size_t type, size_t index) {
  Stack& stack = stacks_[type];
  const NodeRef node = stack[index].node;
  const bool wasTop = index + 1 == stack.size();
  if (!wasTop) {
    stack.erase(stack.begin() + ptrdiff_t(index));
    if (type == viewpointStack) viewer_.left(*node);
    return;
  }
  stack.pop_back();
  const NodeRef next(top(type));
  if (type == viewpointStack) viewer_.unbind(*node, next.get());
  sendBindEvents(*node, false);
  if (next) sendBindEvents(*next, true);
}

void Binding::set(Node& node, bool bound) {
  const size_t type = typeOf(node);
  if (type == types) return;
  if (bound) {
    if (top(type) != &node) push(type, node);
    return;
  }
  Stack& stack = stacks_[type];
  for (size_t i = 0; i < stack.size(); ++i)
    if (stack[i].node.get() == &node) return remove(type, i);
}

bool Binding::dropAbsent() {
  bool dropped = false;
  for (size_t type = 0; type < types; ++type) {
    for (size_t i = 0;
         i < stacks_[type].size();) { // from below: an absent node must not be bound in between
      Entry& entry = stacks_[type][i];
      const bool there = isInScene(*entry.node);
      if (!there && entry.inScene) {
        remove(type, i);
        dropped = true;
        continue;
      }
      entry.inScene = there;
      ++i;
    }
  }
  return dropped;
}

namespace {

// Calls visit for each node of a scope in file order. It skips what is below a node if visit
// returns false.
template <class Visit> void walkScope(const Scope& scope, Visit&& visit) {
  std::vector<Node*> roots = rootsOf(scope);
  std::reverse(roots.begin(), roots.end());
  walk(std::move(roots), [&](Node& node, std::vector<Node*>& open) {
    if (!visit(node)) return;
    const auto before = ptrdiff_t(open.size());
    childrenInScene(node, open);
    std::reverse(open.begin() + before, open.end());
  });
}

} // namespace

void Binding::bindFirst(const Scope& scope) {
  std::array<Node*, types> first{};
  walkScope(scope, [&](Node& node) {
    if (const size_t type = typeOf(node); type != types && !first[type]) first[type] = &node;
    // A Shape holds no bindable node.
    return node.type().index != nodes::Inline::typeIndex &&
           node.type().index != nodes::Shape::typeIndex;
  });
  if (stacks_[viewpointStack].empty()) viewer_.restart();
  for (size_t type = 0; type < types; ++type)
    if (first[type] && stacks_[type].empty()) push(type, *first[type]);
  viewer_.begin();
}

std::vector<Node*> Binding::viewpoints(const Scope& scope) {
  std::vector<Node*> list;
  walkScope(scope, [&](Node& node) {
    if (typeOf(node) == viewpointStack) list.push_back(&node);
    const auto* group = nodeCast<nodes::ViewpointGroup>(&node);
    return !group || group->displayed;
  });
  return list;
}

void Binding::forget(const Node& node) {
  const size_t type = typeOf(node);
  if (type == types) return;
  std::erase_if(stacks_[type], [&](const Entry& entry) { return entry.node.get() == &node; });
  if (type == viewpointStack) viewer_.forget(node);
}

BoundNodes Binding::bound() const { return {top(0), top(1), top(2), top(3)}; }

namespace {

void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  if (isField<"set_bind">(node, in)) interactionOf(events).binding.set(node, std::get<bool>(value));
}

} // namespace

void addBindingBehaviours(const AddBehaviour& add) {
  for (const NodeType* type : nodeTypes())
    if (type->is("bindable")) add(*type, {.receive = receive});
}

} // namespace xvrml
