// comments.h: comments of a world's file.
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Returns the comments at the top of the world's file, including the rest of its header line. They
// end at the first line that is neither a comment nor blank, or after 4096 characters. Returns ""
// for a world without nodes and for one that was not read from a file. The text lives as long as
// the world's first node. [any thread, while the world is at rest]
std::string_view openingComments(const World& world);

} // namespace xvrml
