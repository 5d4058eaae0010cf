// perform_step.h: Does the edits that edit_step.h has read. [the browser's thread, while the world
// can be used]
#pragma once

#include <functional>

#include "as_json/edit_step.h"
#include "edit/world_editor.h"

namespace vv::json::edits {

// Returns the node with a name. Throws CommandError.
using FindNamed = std::function<xvrml::NodeRef(const NodeName& name)>;

// Does the edits of a step, one after the other, and returns the node that each has made; null if
// it makes none. Throws CommandError and xvrml::EditError, which say which edit is meant; those
// before it have been done, so that the caller has to undo them (WorldEditor::step).
xvrml::MFNode perform(const Step& step, WorldEditor& world, const FindNamed& find);

} // namespace vv::json::edits
