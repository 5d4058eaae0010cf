// bindable.cpp: looks up the stacks of bindable nodes by type index. Code asks for every node of a
// world, so names are compared only once.
#include "nodes/bindable.h"

#include "nodes/registry.h"

namespace xvrml {
namespace {

// A stack belongs to an abstract type, or to the only node that uses it. The order is that of
// BindableStack.
constexpr std::string_view owners[bindableStacks] = {"viewpoint", "background", "Fog",
                                                     "NavigationInfo"};

BindableStack find(const NodeType& type) {
  size_t stack = 0;
  while (stack < bindableStacks && type.name != owners[stack] && !type.is(owners[stack])) ++stack;
  return BindableStack(stack);
}

} // namespace

BindableStack bindableStack(const NodeType& type) {
  static const std::vector<BindableStack> byIndex = [] {
    std::vector<BindableStack> all;
    for (const NodeType* each : nodes::builtinNodeTypes()) all.push_back(find(*each));
    return all;
  }();
  return size_t(type.index) < byIndex.size() ? byIndex[size_t(type.index)] : BindableStack::none;
}

} // namespace xvrml
