// edit_nodes.h: Does the edits of a page that are steps of their own: nodes are added, copied,
// moved, removed and renamed, fields get their defaults, Shapes another look. [main thread, while
// the world can be used]
#pragma once

#include "as_json/node_numbers.h"
#include "edit/edit_model.h"
#include "server/edit_command.h"

namespace vv::server {

// Returns the node that a page names. Throws json::CommandError if it has been released.
xvrml::NodeRef nodeOf(const json::NodeNumbers& numbers, uint64_t number);
// Returns a field that holds a value and no nodes. Throws xvrml::EditError.
const xvrml::FieldInfo& valueField(const xvrml::Node& node, const std::string& name);

// Does an edit. model, numbers, view: those of the page. Throws xvrml::EditError and
// json::CommandError; then nothing has changed.
void perform(const edit::NodeCommand& command, WorldEditor& editor, EditModel& model,
             const json::NodeNumbers& numbers, const EditView& view);

} // namespace vv::server
