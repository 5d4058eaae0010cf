// property_widgets.h: The widgets for the rows of a property sheet. They draw what an EditModel
// says and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include "edit/edit_model.h"

namespace vv {

// Closes the menu that is being drawn if Escape was pressed.
void closeOnEscape();
// Draws the name of a field, and the widgets for its value.
void drawProperty(EditModel& model, const xvrml::NodeRef& node, PropertyRow& row);
// Draws the nodes of an SFNode or MFNode, and what may be added.
void drawNodes(EditModel& model, const xvrml::NodeRef& node, const PropertyRow& row);
// Draws how a Shape looks, and what can be chosen instead.
void drawLook(EditModel& model, const PropertySheet& sheet);

} // namespace vv
