// edit_step.h: The edits of one step of the editor, as a client asks for them. They are read and
// checked as far as that is possible without a world; world_edits.cpp does them. [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "as_json/members.h"

namespace vv::json::edits {

// A node that an earlier edit of the step makes: the index of that edit.
struct Made {
  size_t by = 0;
};
using EditedNode = std::variant<std::string, uint64_t, Made>;

// A place for a node.
struct Place {
  std::optional<EditedNode> parent; // none: the roots of the file
  std::string field;                // "" in the place of a node: any of the parent's fields
  std::optional<uint32_t> index;    // none: the end; in the place of a node: any
};

struct SetField {
  EditedNode node;
  std::string field;
  Json value;
};
struct Insert {
  std::string vrml;
  Place to;
};
struct Use {
  EditedNode node;
  Place to;
};
struct Remove {
  EditedNode node;
  std::optional<Place> at; // none: the only place where it stands
};
struct Move {
  EditedNode node;
  std::optional<Place> at;
  Place to;
};
struct Duplicate {
  EditedNode node;
  std::optional<Place> at;
};
struct Wrap {
  EditedNode node;
  std::optional<Place> at;
  std::string type; // that of the new node
};
struct Rename {
  EditedNode node;
  std::string name;
};
struct Route {
  EditedNode from;
  std::string out;
  EditedNode to;
  std::string in;
  bool add = true;
};

using Edit = std::variant<SetField, Insert, Use, Remove, Move, Duplicate, Wrap, Rename, Route>;

struct Step {
  std::string name;
  std::vector<Edit> edits; // at least one
};

// Reads the members of the command "edit". Throws CommandError.
Step readStep(Members& members, size_t mostEdits);

} // namespace vv::json::edits
