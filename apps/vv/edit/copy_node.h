// copy_node.h: Copies a node of another world into the file that is edited. [the browser's thread,
// while the world can be used]
#pragma once

#include "edit/world_editor.h"

namespace vv {

// Inserts a copy of a node, with all that is in it but metadata and names. Relative URLs lead to
// the same files as before. Call it within a step. Returns the copy. Throws xvrml::EditError, also
// if there are instances of prototypes or Scripts in the node, which the file does not know.
xvrml::NodeRef copyNode(WorldEditor& editor, const xvrml::NodeSlot& slot,
                        const xvrml::NodeRef& node);

} // namespace vv
