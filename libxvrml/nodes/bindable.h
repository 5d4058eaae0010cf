// bindable.h: the four stacks of bindable nodes (clause 4.6.10), and which node types share one.
// The abstract types in bindable.node say it. [any thread]
#pragma once

#include <cstdint>

#include "xvrml/node.h"

namespace xvrml {

// In the order of the members of BoundNodes (xvrml/camera.h).
enum class BindableStack : uint8_t { viewpoint, background, fog, navigationInfo, none };
inline constexpr size_t bindableStacks = size_t(BindableStack::none);

// Returns the stack of a built-in type; none for other types, those of plug-ins included.
BindableStack bindableStack(const NodeType& type);

} // namespace xvrml
