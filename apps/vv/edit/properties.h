// properties.h: The fields of a node as rows that a face draws. [the browser's thread, while the
// world can be used]
#pragma once

#include <string>
#include <vector>

#include "edit/world_editor.h"

namespace vv {

struct PropertyRow {
  const xvrml::FieldInfo* field = nullptr; // a row of the node's type
  xvrml::Value value;                      // empty for lists that are too long to be shown
  size_t size = 0;                         // elements of a list
  bool isDefault = false;
  bool isLong = false; // the list has more than `mostElements`
};

struct PropertySheet {
  static constexpr size_t mostElements = 200;

  xvrml::NodeRef node; // null: nothing is selected
  std::string title;   // "LAMP  PointLight"
  std::string note;    // what is special: places, prototype; "" if nothing is
  std::vector<PropertyRow> rows;
};

// Returns the sheet of a node: its fields and exposedFields, without metadata.
PropertySheet sheetOf(WorldEditor& editor, const xvrml::NodeRef& node);
// Reads the values again. Other nodes, and nodes of a Script whose fields have changed, need
// sheetOf.
void refresh(PropertySheet& sheet);

} // namespace vv
