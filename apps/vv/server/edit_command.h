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
// A place of the picture, from -1 to 1.
struct Place {
  double x = 0, y = 0;
};
struct SelectAt {
  Place place;
  bool group = false, add = false;
};
struct Drag {
  uint64_t node = 0;
  std::string field;
  json::Json value;
};
struct EndDrag {};
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
struct PutProbe {
  Place place;
};
struct KeepProbes {};
struct ClearProbes {};
struct Close {};

using Command = std::variant<ShowRows, Search, Open, Select, SelectAt, Drag, EndDrag, Reset,
                             json::edits::Step, Add, Duplicate, Remove, Wrap, Undo, Save, Revert,
                             Recover, PutProbe, KeepProbes, ClearProbes, Close>;

// Reads a message {"type":"edit","command":...}. Throws json::CommandError.
Command readCommand(json::Json message);

} // namespace vv::server::edit
