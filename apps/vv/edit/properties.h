// properties.h: The fields of a node as rows that a face draws. [the browser's thread, while the
// world can be used]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edit/looks.h"
#include "edit/node_fields.h"

namespace vv {

struct PropertyRow {
  // A row of the node's type, or the field that its ORTShader could declare for a parameter.
  const xvrml::FieldInfo* field = nullptr;
  std::shared_ptr<const xvrml::FieldInfo> parameter; // keeps the latter
  xvrml::Value value;                                // empty if it is too long to be shown
  xvrml::Value shown; // a list as it was read, which a face does not change
  xvrml::Value defaultValue;
  size_t size = 0; // elements of a list
  bool isDefault = false;
  bool isLong = false;      // it is not shown: it has more than `mostElements` or `mostBytes`
  bool isDeclared = true;   // false: the shader gets the field when it is changed
  bool isLinear = false;    // its colours are linear, as those of shaders; others are sRGB codes
  bool isInOptions = false; // the options of the shader set it; what is no number is not shown
  uint64_t edits = 0;       // Editor::editsOf() when the value was read
  xvrml::FieldRange range;  // the range of each number
  std::string help;         // type, range and what the field does
  std::vector<std::string> choices; // words that a field of strings may hold
  // --- Fields of nodes ---
  std::vector<size_t> places;                  // in how many places each node of the value stands
  std::vector<const xvrml::NodeType*> addable; // what may be added
  std::vector<xvrml::NodeRef> usable;          // nodes of the file that may stand here, too

  // Returns whether a change of the value changes the options of the shader.
  bool isOption() const { return isInOptions && !isLong; }
};

struct PropertySheet {
  // Longer lists, texts and pictures are not shown.
  static constexpr size_t mostElements = 200, mostBytes = 32'768;

  xvrml::NodeRef node; // null: nothing is selected
  std::string title;   // "LAMP  PointLight"
  std::string note;    // what is special: places, prototype; "" if nothing is
  std::vector<PropertyRow> rows;
  bool hasLook = false; // the node is a Shape
  ShapeLook look;
  std::string shaderOption; // as of shaderOption()

  // Returns the row of a field; null: there is none.
  const PropertyRow* find(const std::string& field) const;
};

// Returns the sheet of a node: its fields and exposedFields, without metadata, and the parameters
// of a shader's class.
PropertySheet sheetOf(WorldEditor& editor, const xvrml::NodeRef& node);
// Reads the values again. Returns false if the node has other rows now, so that sheetOf is needed:
// an ORTShader of another class. Other nodes, nodes that stand elsewhere, and nodes of a Script
// whose fields have changed need sheetOf, too.
bool refresh(WorldEditor& editor, PropertySheet& sheet);

} // namespace vv
