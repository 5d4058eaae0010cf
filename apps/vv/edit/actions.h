// actions.h: The actions of a user on the nodes that are selected. Each action is one step. They
// throw xvrml::EditError. [the browser's thread, while the world can be used]
#pragma once

#include <span>
#include <string>

#include "edit/edit_model.h"

namespace vv {

// Returns the node that was hit: the Shape, or with `group` the nearest group above it; null if
// there is none. Nodes that are not in the world's file stand for the node of the file that they
// belong to: an Inline, or an instance of a prototype.
xvrml::NodeRef nodeOf(WorldEditor& editor, xvrml::PickHit hit, bool group);
// Selects this node at a place of the picture, or nothing. add: as in WorldEditor::choose().
void selectAt(WorldEditor& editor, const EditView& view, double x, double y, bool group, bool add);

void removeSelected(WorldEditor& editor);
void duplicateSelected(WorldEditor& editor); // selects the copies
void wrapSelected(WorldEditor& editor);      // puts a Transform around each, and selects it

// A node that a user can add.
struct NewNode {
  const char* name; // the type of a node, or of the geometry of a Shape
  bool isGeometry;
};
std::span<const NewNode> newNodes();
// Returns the place for a new node: at the end of the group that is selected, or else behind the
// selected node, or else at the end of the world.
xvrml::NodeSlot placeForNew(WorldEditor& editor);
// Adds a node there, and selects it.
void add(WorldEditor& editor, const NewNode& node);
// Adds a Viewpoint that looks as the viewer does.
void addViewpoint(WorldEditor& editor, const EditView& view);

} // namespace vv
