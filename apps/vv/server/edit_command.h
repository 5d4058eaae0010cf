// edit_command.h: Reads the messages by which a page edits the world. As all messages of pages they
// are hostile: a command has exactly its members, each of its kind and within its range. Nodes are
// named by numbers that the page was given; values of fields stay JSON until the field's type is
// known. docs/serve.md lists the commands. [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "as_json/edit_step.h"

namespace vv::server::edit {

// --- What is shown and selected ---

struct ShowRows {
  int first = 0, count = 0; // the rows of the outline that the page shows
};
struct Search {
  std::string text; // "": shows the tree
};
struct Open {
  uint64_t node = 0;
  bool open = true;
};
struct Select {
  std::optional<uint64_t> node; // none: nothing is to be selected
  bool add = false;
};
// A place of the picture, from -1 to 1; that of a pointer which drags may be outside.
struct Place {
  double x = 0, y = 0;
};
struct SelectAt {
  Place place;
  bool group = false, add = false;
};
struct SelectIn {
  Place from, to; // corners of a rectangle
  bool add = false;
};
struct SelectSameLook {};
struct AskChoices {
  uint64_t node = 0;
  std::string field;
};
struct ShowList {
  enum class What : uint8_t { problems, looks };
  What what = What::problems;
  bool open = true;
};
struct Hide {
  enum class What : uint8_t { selected, others, nothing };
  What what = What::selected;
};
struct Frame {}; // the viewer goes to what is selected
struct Close {};

// --- Values, history and file ---

// One element of a list that the page shows with so many elements.
struct Element {
  size_t index = 0, size = 0; // index == size: one behind the last
};
struct Drag {
  uint64_t node = 0;
  std::string field;
  json::Json value;               // null removes an element
  std::optional<Element> element; // none: it is the value of the whole field
};
struct EndDrag {};
struct Undo {
  bool again = false; // redo
};
struct Save {
  bool overwrite = false;
};
struct Revert {};
struct Recover {
  bool use = true; // false: the edits that an earlier program has left are thrown away
};

// --- Edits that are steps of their own ---

struct Reset {
  uint64_t node = 0;
  std::string field;
};
struct Add {
  std::string kind; // a name of newNodes(), or viewpointKind
};
struct Duplicate {};
struct Remove {};
struct Wrap {};
struct AddNode {
  uint64_t node = 0;
  std::string field, kind; // kind: the type of the new node
};
struct UseNode {
  uint64_t node = 0;
  std::string field;
  uint64_t used = 0;
};
// A node at one of its places.
struct At {
  uint64_t node = 0;
  std::optional<uint64_t> parent; // none: the node is a root of the file
  std::string field;
  size_t index = 0;
};
struct RemoveAt {
  At at;
};
struct MoveAt {
  At at;
  int by = 1; // places in its list
};
struct SeparateAt {
  At at;
};
struct SetLook {
  uint64_t number = 0; // that of a look which the page was sent
  bool onlyHere = true;
};
using Step = json::edits::Step;
using NodeCommand = std::variant<Reset, Step, Add, Duplicate, Remove, Wrap, AddNode, UseNode,
                                 RemoveAt, MoveAt, SeparateAt, SetLook>;

// --- Handles and tools over the picture ---

struct BeginTool {
  enum class Kind : uint8_t { move, turn, scale };
  Kind kind = Kind::move;
  int axis = -1; // 0 to 2; -1: none
  Place place;
};
struct PointTool {
  Place place;
  bool snap = false;
};
struct TypeTool {
  std::string key; // "X", "Y", "Z", or a key of a number
};
struct EndTool {
  bool accept = true;
};
struct NextHandles {};
using ToolCommand = std::variant<BeginTool, PointTool, TypeTool, EndTool, NextHandles>;

// --- Light ---

struct PutProbe {
  Place place;
  bool illuminance = false;
};
struct Measure {
  Place from, to; // corners of a rectangle
};
struct KeepProbes {};
struct ClearProbes {};
struct Compare {
  enum class What : uint8_t { a, wiper, difference };
  What what = What::a;
};
struct PointAt {
  std::optional<Place> place; // where the pointer rests; none: it does not
};
struct KeepInWorld {
  int probe = 0; // its number
};
struct NameProbe {
  int probe = 0; // its number
  std::string name;
};
struct ShowSensors {};
struct ProbeTable {};
struct Report {};
using LightCommand = std::variant<PutProbe, Measure, KeepProbes, ClearProbes, Compare, PointAt,
                                  KeepInWorld, NameProbe, ShowSensors, ProbeTable, Report>;

// --- Files that are put into the world ---

struct Import {
  std::string name;
  size_t bytes = 0; // which the page will send
};
struct ImportPart {
  std::string data; // in base64
};
using FileCommand = std::variant<Import, ImportPart>;

using Command = std::variant<ShowRows, Search, Open, Select, SelectAt, SelectIn, SelectSameLook,
                             AskChoices, ShowList, Hide, Frame, Close, Drag, EndDrag, Undo, Save,
                             Revert, Recover, NodeCommand, ToolCommand, LightCommand, FileCommand>;

// Reads a message {"type":"edit","command":...}. Throws json::CommandError.
Command readCommand(json::Json message);

} // namespace vv::server::edit
