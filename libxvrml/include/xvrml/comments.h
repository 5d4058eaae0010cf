// comments.h: what stands in a world's file beside its nodes.
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Returns the comments at the top of the world's file, the rest of its header line included, up to
// the first line that is neither a comment nor blank and at most 4096 characters. "" for a world
// without nodes and for one that no file was read for. It is valid as long as the world's first
// node. [any thread, while the world is at rest]
std::string_view openingComments(const World& world);

} // namespace xvrml
