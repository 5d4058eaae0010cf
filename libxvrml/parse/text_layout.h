// text_layout.h: where the nodes, fields and routes of a world stand in its text, for programs that
// change a part of the text and leave the rest. Prototypes are left out: nothing within them is
// changed. [the thread that loads]
#pragma once

#include <string>
#include <vector>

#include "parse/xml_index.h"
#include "xvrml/node.h"

namespace xvrml {

// Returns a key for a place in a file.
inline uint64_t placeKey(uint32_t line, uint32_t column) { return uint64_t(line) << 32 | column; }

// A node, a USE or NULL at one place in a list of nodes, or as the value of an SFNode.
struct NodePlace {
  TextSpan span;
  const Node* node = nullptr; // null: NULL
  bool isUse = false;         // the node itself stands further up
  bool taken = true;          // the world has the node at this place
};

// How a text gives a field to a node.
enum class FieldForm : uint8_t {
  statement, // VRML97 and ClassicVRML: a name and a value. JSON: a member of the node's object
  attribute, // XML: an attribute of the node's element
  element,   // XML and JSON: a field or fieldValue, with the value in it
  children,  // XML: child elements of the node's element
  program    // XML and JSON: the program in a Script's own text, the last string of its url
};

struct FieldText {
  std::string name; // as the node's type has it
  FieldForm form = FieldForm::statement;
  TextSpan whole; // from its name to the end of its value; an element; empty for `children`
  TextSpan value; // between the quotes of an attribute; 0: there is none
  std::vector<NodePlace> nodes; // what stands in the value of an SFNode or MFNode
  bool declared = false;        // the node declares the field: it has a value in any case
  bool readable = false;        // the whole value could be read
  bool faithful = false;        // the world has taken all of it
};

struct NodeText {
  NodeRef node; // keeps a node that the world has not taken, because places refer to it
  // From DEF, or from the type, to the closing brace; an element; in JSON the object around it.
  TextSpan whole;
  TextSpan name; // the name behind DEF; empty if there is none
  TextSpan body; // from behind the opening brace to behind the closing one; empty in XML
  // JSON: the containerField, and the list of the fieldValues of an instance. 0: there is none.
  TextSpan container, values;
  std::vector<FieldText> fields; // in the order of the text
};

struct RouteText {
  TextSpan whole;
  TextSpan from, to; // the names of the nodes
  uint32_t line = 0, column = 0;
  bool valid = false; // the world has the route
};

// A PROTO or EXTERNPROTO outside of other prototypes.
struct PrototypeText {
  TextSpan whole;
  uint32_t line = 0, column = 0; // where its name stands
};

struct TextLayout {
  std::vector<NodeText> nodes; // in the order of their ends
  std::vector<NodePlace> roots;
  std::vector<RouteText> routes;
  std::vector<PrototypeText> prototypes;
  XmlIndex xml; // empty for other encodings
  // JSON: the object of the Scene from behind its opening brace on, and the list of its nodes.
  // 0: there is none.
  TextSpan scene, sceneList;
  // Says why the text cannot be changed in place, behind "the file"; empty if it can.
  std::string whyNot;
};

} // namespace xvrml
