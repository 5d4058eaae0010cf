// command.h: The commands of the control channel, and their reader. A command is checked as far as
// that is possible without a world: its members, their types and ranges. Values of fields stay
// JSON until the field's type is known (field_json.h). [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "as_json/edit_step.h"
#include "as_json/node_name.h"
#include "control/limits.h"

namespace vv::control {

struct Assignment {
  FieldName to;
  Json value;
};

struct Hello {};
struct Get {
  FieldName from;
};
struct Set {
  std::vector<Assignment> values; // set in one step; at least one
};
struct Subscribe {
  FieldName to;
  bool on = true; // false: unsubscribe
};
struct Create {
  std::string vrml;
};
struct ChangeRoots {
  NodeName node;
  bool add = true;
};
struct Release {
  std::vector<uint64_t> nodes;
};
struct ChangeRoute {
  FieldName from, to;
  bool add = true;
};
struct Describe {
  NodeName node;
};
struct ListNames {};
struct ListViewpoints {};
struct Bind {
  std::string viewpoint; // a DEF name, a description or a number from 0
};
struct Load {
  std::vector<std::string> urls;
};
struct Replace {
  std::vector<NodeName> nodes;
};
struct Render {
  std::optional<int> width, height, samples;
  std::vector<std::string> channels; // empty: those of the command line
  std::string file;                  // "": the answer holds the bytes
  std::string format;                // its suffix; "": png, or that of the file
};
struct Time {
  std::optional<bool> paused;
  std::optional<double> skip; // seconds
};
struct PressKey {
  std::string key;             // a name of xvrml::Browser::worldKey; "": text
  std::optional<bool> pressed; // nothing: pressed and released
  std::string text;
};
struct Undo {
  bool again = false; // redo
};
struct Save {
  std::string path; // "": the world's own file
  bool overwrite = false;
};
struct ListEdits {
  bool withText = false;
};
struct ListRoots {};
struct ListParents {
  NodeName node;
};
struct Select {
  std::vector<NodeName> nodes;
};
struct ListSelection {};
struct ListParameters {
  std::string shaderClass, file; // ORTShader.name and ORTShader.file
};
struct Pick {
  double x = 0, y = 0; // picture coordinates, as in InputEvent
};
struct Probe {
  Pick place;
  std::optional<int> samples;
  bool illuminance = false; // that of the surface there; otherwise its luminance
};
struct Measure {
  std::optional<int> samples;
};
struct Recover {
  bool use = true; // false: they are thrown away
};
struct Quit {
  bool discard = false; // edits that are not saved
};

using Action =
    std::variant<Hello, Get, Set, Subscribe, Create, ChangeRoots, Release, ChangeRoute, Describe,
                 ListNames, ListViewpoints, Bind, Load, Replace, Render, Time, Quit, PressKey,
                 edits::Step, Undo, Save, ListEdits, ListRoots, ListParents, Select, ListSelection,
                 ListParameters, Pick, Probe, Measure, Recover>;

struct Command {
  std::string id;     // the client's "id" as JSON text, for the answer; "": none
  std::string name;   // "get", for messages
  bool quiet = false; // no answer unless it fails
  Action action;
};

// Holds what the reader found: a command, or an error that is the answer.
struct Line {
  std::string id;
  std::optional<Command> command;
  std::string code, message; // without a command: why there is none
};

// Reads a line without its line feed. Never throws for anything that a client can send.
Line readLine(std::string_view line, const Limits& allowed = limits);

// Returns the answer to a command that failed, without a line feed.
std::string errorAnswer(const std::string& id, std::string_view code, std::string_view message);

} // namespace vv::control
