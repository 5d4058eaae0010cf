// property_widgets.h: The widgets for the rows of a property sheet. They draw what an EditModel
// says and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include "edit/edit_model.h"
#include "edit/look_library.h"
#include "window/thumbnails.h"

namespace vv {

// Draws the name of a field, and the widgets for its value.
void drawProperty(EditModel& model, const xvrml::NodeRef& node, PropertyRow& row,
                  Thumbnails& thumbnails);
// Draws the nodes of an SFNode or MFNode, and what may be added.
void drawNodes(EditModel& model, const xvrml::NodeRef& node, const PropertyRow& row,
               Thumbnails& thumbnails);
// Draws the small picture of a texture node, or why there is none; nothing for other nodes.
void drawThumbnail(const EditModel& model, const xvrml::Node& node, Thumbnails& thumbnails);
// Draws how the selected Shape looks, and what can be chosen instead. Returns whether the user is
// choosing.
bool drawLook(EditModel& model, LookLibrary& library, Thumbnails& thumbnails);

} // namespace vv
