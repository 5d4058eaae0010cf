#include "server/edit_command.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "server/limits.h"

namespace vv::server::edit {

using json::CommandError;
using json::Json;
using json::Members;

namespace {

constexpr size_t mostSearchBytes = 256, mostNameBytes = 200;
constexpr int largestRow = 100'000'000;

uint64_t numberOfNode(const std::string& where, const Json& value) {
  if (!value.is_number_unsigned()) json::refuse(where, "the number of a node", value);
  return value.get<uint64_t>();
}
uint64_t node(Members& m) { return numberOfNode(m.at("node"), m.need("node")); }

// A missing switch is off.
bool flag(Members& m, const char* name) {
  return m.has(name) && json::switchOf(m.at(name), m.need(name));
}

std::string text(Members& m, const char* name, size_t longest) {
  std::string read = m.text(name);
  if (read.size() > longest)
    throw CommandError("limit", fmt::format("{}: at most {} bytes", m.at(name), longest));
  return read;
}

Place place(Members& m) {
  const auto read = [&](const char* name) {
    return json::numberOf(m.at(name), m.need(name), "a number", -1, 1);
  };
  return {read("x"), read("y")};
}

Command readRows(Members& m) {
  const int first = json::wholeNumberOf(m.at("first"), m.need("first"), 0, largestRow);
  return ShowRows{first, json::wholeNumberOf(m.at("count"), m.need("count"), 0, maxRowsShown)};
}

Command readOpen(Members& m) {
  const uint64_t opened = node(m);
  return Open{opened, json::switchOf(m.at("open"), m.need("open"))};
}

Command readSelect(Members& m) {
  Select select;
  if (const Json& named = m.need("node"); !named.is_null())
    select.node = numberOfNode(m.at("node"), named);
  select.add = flag(m, "add");
  return select;
}

Command readSelectAt(Members& m) {
  SelectAt select{place(m)};
  select.group = flag(m, "group");
  select.add = flag(m, "add");
  return select;
}

Command readDrag(Members& m) {
  Drag drag{node(m), m.text("field"), nullptr};
  drag.value = std::move(m.need("value"));
  return drag;
}

Command readReset(Members& m) {
  const uint64_t edited = node(m);
  return Reset{edited, m.text("field")};
}

Command readStep(Members& m) {
  json::edits::Step step = json::edits::readStep(m, maxEditsOfStep);
  if (step.name.size() > mostNameBytes)
    throw CommandError("limit", fmt::format("{}: at most {} bytes", m.at("name"), mostNameBytes));
  return step;
}

struct Row {
  const char* name;
  Command (*read)(Members& members);
};

constexpr Row table[] = {
    {"rows", readRows},
    {"search", [](Members& m) -> Command { return Search{text(m, "text", mostSearchBytes)}; }},
    {"open", readOpen},
    {"select", readSelect},
    {"select_at", readSelectAt},
    {"drag", readDrag},
    {"end_drag", [](Members&) -> Command { return EndDrag{}; }},
    {"reset", readReset},
    {"step", readStep},
    {"add", [](Members& m) -> Command { return Add{m.text("kind")}; }},
    {"duplicate", [](Members&) -> Command { return Duplicate{}; }},
    {"remove", [](Members&) -> Command { return Remove{}; }},
    {"wrap", [](Members&) -> Command { return Wrap{}; }},
    {"undo", [](Members&) -> Command { return Undo{false}; }},
    {"redo", [](Members&) -> Command { return Undo{true}; }},
    {"save", [](Members& m) -> Command { return Save{flag(m, "overwrite")}; }},
    {"revert", [](Members&) -> Command { return Revert{}; }},
    {"recover",
     [](Members& m) -> Command { return Recover{json::switchOf(m.at("use"), m.need("use"))}; }},
    {"probe", [](Members& m) -> Command { return PutProbe{place(m)}; }},
    {"keep_probes", [](Members&) -> Command { return KeepProbes{}; }},
    {"clear_probes", [](Members&) -> Command { return ClearProbes{}; }},
    {"close", [](Members&) -> Command { return Close{}; }},
};

} // namespace

Command readCommand(Json message) {
  Members members("edit", std::move(message));
  static_cast<void>(members.need("type"));
  const std::string name = members.text("command");
  const Row* const row = std::find_if(std::begin(table), std::end(table),
                                      [&](const Row& one) { return name == one.name; });
  if (row == std::end(table))
    throw CommandError("command", fmt::format("there is no command {}", json::shownJson(name)));
  Command command = row->read(members);
  members.rest();
  return command;
}

} // namespace vv::server::edit
