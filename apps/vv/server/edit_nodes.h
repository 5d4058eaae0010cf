// edit_nodes.h: Does the edits of a page that are steps of their own: nodes are added, copied,
// moved, removed and renamed, fields get their defaults, Shapes another look. [main thread, while
// the world can be used]
#pragma once

#include <functional>

#include "as_json/node_numbers.h"
#include "edit/edit_model.h"
#include "server/edit_command.h"

namespace vv::server {

// Returns the node that a page names. Throws json::CommandError if it has been released.
xvrml::NodeRef nodeOf(const json::NodeNumbers& numbers, uint64_t number);
// Returns a field that holds a value and no nodes. Throws xvrml::EditError.
const xvrml::FieldInfo& valueField(const xvrml::Node& node, const std::string& name);
// Returns the value that a drag gives to a field. now: the present one, whose other elements stay
// if the drag is about one. Throws json::CommandError, and xvrml::EditError if elements have been
// added or removed since the page was sent the list: it is not known then which one is meant.
xvrml::Value draggedValue(const edit::Drag& drag, const xvrml::Node& node,
                          const xvrml::FieldInfo& field, const xvrml::Value& now);

// Returns the look that a page names by its number. Throws xvrml::EditError.
using FindLook = std::function<const Look&(uint64_t number)>;

// Does an edit. model, numbers, view: those of the page. Throws xvrml::EditError and
// json::CommandError; then nothing has changed.
void perform(const edit::NodeCommand& command, WorldEditor& editor, EditModel& model,
             const json::NodeNumbers& numbers, const EditView& view, const FindLook& findLook);

} // namespace vv::server
