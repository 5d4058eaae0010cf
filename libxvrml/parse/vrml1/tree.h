// tree.h: a VRML 1.0 file as it is written: its nodes with their fields and children. The reader
// makes the tree, and the converter makes the VRML97 graph from it. The tree lives only while a
// file is loaded. Node types are a table of their own, because names and fields that VRML97 has,
// too, mean something else here. [the thread that loads]
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/node.h"

namespace xvrml::vrml1 {

enum class Kind : uint8_t {
  asciiText,
  cone,
  coordinate3,
  cube,
  cylinder,
  directionalLight,
  fontStyle,
  group,
  indexedFaceSet,
  indexedLineSet,
  info,
  lod,
  material,
  materialBinding,
  matrixTransform,
  normal,
  normalBinding,
  orthographicCamera,
  perspectiveCamera,
  pointLight,
  pointSet,
  rotation,
  scale,
  separator,
  shapeHints,
  sphere,
  spotLight,
  switchNode,
  texture2,
  texture2Transform,
  textureCoordinate2,
  transform,
  transformSeparator,
  translation,
  wwwAnchor,
  wwwInline,
  vrml97, // a node of VRML97 that files in VRML 1.0 hold: Background, Fog ...
  unknown
};

// How a value is written. All but `plain` have a spelling of their own: one word (SFEnum, kept as
// an SFString), words in parentheses (SFBitMask, kept as an MFString), 16 numbers (SFMatrix, kept
// as an MFFloat).
enum class Spelling : uint8_t { plain, enumeration, bitMask, matrix };

struct Field {
  std::string name;
  FieldType type;
  Spelling spelling;
  Value value; // the default
  // A field that VRML 1.0 does not have and that real files use. It is read with a warning.
  bool extension = false;
};

struct TreeNode;

struct Type {
  Kind kind;
  std::string name;
  std::vector<Field> fields;
  // Returns the field's number, or -1.
  int find(std::string_view field) const;
};

// Returns the 36 node types of VRML 1.0, in alphabetical order.
const std::vector<Type>& types();
// Returns the type of that name, or null. Selection and Annotation of Open Inventor are found as
// Separator.
const Type* findType(std::string_view name);
// Returns a node of that kind with its defaults, for state that no node has set.
const TreeNode& defaultNode(Kind kind);
// Finds a field type by its name in VRML 1.0 (SFLong, SFBitMask ...).
bool fieldTypeNamed(std::string_view name, FieldType& type, Spelling& spelling);

struct TreeNode {
  const Type* type = nullptr; // null: a node of another kind than those of the table
  Kind kind = Kind::unknown;
  const char* at = nullptr; // place in the file
  SourcePosition source;
  std::string name;                  // DEF name, or empty
  bool shared = false;               // there is a USE of it
  mutable std::vector<Value> values; // those of the type's fields
  std::vector<bool> given;           // fields that the file gives
  std::vector<const TreeNode*> children;
  NodeRef vrml97; // the node, if kind is vrml97

  template <class T> const T& get(std::string_view field) const {
    return std::get<T>(values[static_cast<size_t>(type->find(field))]);
  }
  // Moves a value out of the tree. For big arrays, of which the graph needs one copy only.
  template <class T> T take(std::string_view field) const {
    return std::move(std::get<T>(values[static_cast<size_t>(type->find(field))]));
  }
  bool has(std::string_view field) const {
    const int number = type->find(field);
    return number >= 0 && given[static_cast<size_t>(number)];
  }
};

struct Tree {
  std::deque<TreeNode> nodes; // deques do not move their elements
  std::vector<const TreeNode*> roots;
};

} // namespace xvrml::vrml1
