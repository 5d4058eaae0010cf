// node_fields.h: Edits of the fields that hold nodes, and of one of several places of a node. Each
// edit is one step. They throw xvrml::EditError. [the browser's thread, while the world can be
// used]
#pragma once

#include <string>
#include <vector>

#include "edit/world_editor.h"

namespace vv {

// A node at one of its places. A face shows it; when the edit is done, it may have gone.
struct PlacedNode {
  xvrml::NodeRef node;
  xvrml::NodeRef parent; // null: the node is a root of the file
  std::string field;
  size_t index = 0;
};

// Returns the types of nodes that may stand in a field, by name: all of them if the field says
// nothing.
std::vector<const xvrml::NodeType*> typesFor(const xvrml::FieldInfo& field);
// Returns nodes of the file with names that may stand in a field; at most `most`.
std::vector<xvrml::NodeRef> nodesFor(const xvrml::World& world, const xvrml::FieldInfo& field,
                                     size_t most);

// Inserts a new node of a type, as the encoding of the file writes it. Returns the node.
xvrml::NodeRef insertNew(WorldEditor& editor, const xvrml::NodeSlot& slot, const std::string& type);
// Puts a new node at the end of a field. In an SFNode it takes the place of the present one.
void addNode(WorldEditor& editor, const xvrml::NodeRef& parent, const std::string& field,
             const xvrml::NodeType& type);
// Lets a node of the file stand there, too.
void useNode(WorldEditor& editor, const xvrml::NodeRef& parent, const std::string& field,
             const xvrml::NodeRef& node);
// Removes a node from one place; it stays in its others.
void removeAt(WorldEditor& editor, const PlacedNode& place);
// Moves a node within its list: by 1 behind the next one, by -1 before the one before. At the ends
// of the list nothing happens.
void moveBy(WorldEditor& editor, const PlacedNode& place, int by);
// Puts a copy of the node at this place, so that it can be edited without its other places. Selects
// the copy if the node was selected.
void separateAt(WorldEditor& editor, const PlacedNode& place);

} // namespace vv
