#include "server/edit_command.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "server/limits.h"

namespace vv::server::edit {

using json::CommandError;
using json::Json;
using json::Members;

namespace {

constexpr size_t mostSearchBytes = 256, mostNameBytes = 200, mostKeyBytes = 16;
constexpr size_t mostFileNameBytes = 1024;
constexpr int largestRow = 100'000'000, largestIndex = std::numeric_limits<int>::max();
constexpr double farthest = 100; // a pointer that drags outside of the picture

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

// Returns the number of a word.
int choice(Members& m, const char* name, std::span<const char* const> words) {
  const std::string read = m.text(name);
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const char* word) { return read == word; });
  if (found != words.end()) return int(found - words.begin());
  std::string expected = "one of";
  for (const char* word : words) expected += std::string(" ") + word;
  throw CommandError("value", fmt::format("{}: {} was expected", m.at(name), expected));
}

Place place(Members& m, const char* x = "x", const char* y = "y", double most = 1) {
  const auto read = [&](const char* name) {
    return json::numberOf(m.at(name), m.need(name), "a number", -most, most);
  };
  return {read(x), read(y)};
}

size_t count(Members& m, const char* name) {
  return size_t(json::wholeNumberOf(m.at(name), m.need(name), 0, largestIndex));
}

int probe(Members& m) {
  return json::wholeNumberOf(m.at("probe"), m.need("probe"), 1, largestIndex);
}

bool isOpen(Members& m) { return json::switchOf(m.at("open"), m.need("open")); }

Place from(Members& m) { return place(m, "x0", "y0"); }
Place to(Members& m) { return place(m, "x1", "y1"); }

Command readRows(Members& m) {
  const int first = json::wholeNumberOf(m.at("first"), m.need("first"), 0, largestRow);
  return ShowRows{first, json::wholeNumberOf(m.at("count"), m.need("count"), 0, maxRowsShown)};
}

Command readOpen(Members& m) {
  const uint64_t opened = node(m);
  return Open{opened, isOpen(m)};
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
  Drag drag{node(m), m.text("field"), nullptr, {}};
  drag.value = std::move(m.need("value"));
  if (m.has("index")) {
    const size_t index = count(m, "index");
    drag.element = Element{index, count(m, "size")};
  }
  return drag;
}

Command readReset(Members& m) {
  const uint64_t edited = node(m);
  return NodeCommand(Reset{edited, m.text("field")});
}

Command readStep(Members& m) {
  Step step = json::edits::readStep(m, maxEditsOfStep);
  if (step.name.size() > mostNameBytes)
    throw CommandError("limit", fmt::format("{}: at most {} bytes", m.at("name"), mostNameBytes));
  return NodeCommand(std::move(step));
}

Command readSelectIn(Members& m) {
  SelectIn select{from(m), to(m)};
  select.add = flag(m, "add");
  return select;
}

Command readAskChoices(Members& m) {
  const uint64_t asked = node(m);
  return AskChoices{asked, m.text("field")};
}

// --- Edits of nodes ---

Command readAddNode(Members& m) {
  AddNode add{node(m), m.text("field"), {}};
  add.kind = text(m, "kind", mostNameBytes);
  return NodeCommand(std::move(add));
}

Command readUseNode(Members& m) {
  UseNode use{node(m), m.text("field")};
  use.used = numberOfNode(m.at("used"), m.need("used"));
  return NodeCommand(std::move(use));
}

At readAt(Members& m) {
  At at{node(m)};
  if (const Json& parent = m.need("parent"); !parent.is_null())
    at.parent = numberOfNode(m.at("parent"), parent);
  at.field = m.text("field");
  at.index = count(m, "index");
  return at;
}

Command readMoveAt(Members& m) {
  MoveAt move{readAt(m)};
  move.by = json::wholeNumberOf(m.at("by"), m.need("by"), -1, 1);
  return NodeCommand(std::move(move));
}

Command readSetLook(Members& m) {
  const size_t number = count(m, "number");
  return NodeCommand(SetLook{number, flag(m, "only_here")});
}

Command readImport(Members& m) {
  std::string name = text(m, "name", mostFileNameBytes);
  return FileCommand(Import{std::move(name), count(m, "bytes")});
}

// --- Tools and light ---

Command readBeginTool(Members& m) {
  constexpr const char* kinds[] = {"move", "turn", "scale"};
  BeginTool begin{BeginTool::Kind(choice(m, "kind", kinds))};
  if (m.has("axis")) begin.axis = json::wholeNumberOf(m.at("axis"), m.need("axis"), 0, 2);
  begin.place = place(m, "x", "y", farthest);
  return ToolCommand(begin);
}

Command readPointTool(Members& m) {
  PointTool point{place(m, "x", "y", farthest)};
  point.snap = flag(m, "snap");
  return ToolCommand(point);
}

Command readPutProbe(Members& m) {
  PutProbe put{place(m)};
  put.illuminance = flag(m, "illuminance");
  return LightCommand(put);
}

Command readCompare(Members& m) {
  constexpr const char* names[] = {"a", "wiper", "difference"};
  return LightCommand(Compare{Compare::What(choice(m, "what", names))});
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
    {"select_in", readSelectIn},
    {"select_same_look", [](Members&) -> Command { return SelectSameLook{}; }},
    {"choices", readAskChoices},
    {"problems",
     [](Members& m) -> Command {
       return ShowList{ShowList::What::problems, isOpen(m)};
     }},
    {"looks",
     [](Members& m) -> Command {
       return ShowList{ShowList::What::looks, isOpen(m)};
     }},
    {"hide", [](Members&) -> Command { return Hide{Hide::What::selected}; }},
    {"hide_others", [](Members&) -> Command { return Hide{Hide::What::others}; }},
    {"show_all", [](Members&) -> Command { return Hide{Hide::What::nothing}; }},
    {"frame", [](Members&) -> Command { return Frame{}; }},
    {"close", [](Members&) -> Command { return Close{}; }},
    {"drag", readDrag},
    {"end_drag", [](Members&) -> Command { return EndDrag{}; }},
    {"undo", [](Members&) -> Command { return Undo{false}; }},
    {"redo", [](Members&) -> Command { return Undo{true}; }},
    {"save", [](Members& m) -> Command { return Save{flag(m, "overwrite")}; }},
    {"revert", [](Members&) -> Command { return Revert{}; }},
    {"recover",
     [](Members& m) -> Command { return Recover{json::switchOf(m.at("use"), m.need("use"))}; }},
    {"reset", readReset},
    {"step", readStep},
    {"add", [](Members& m) -> Command { return NodeCommand(Add{m.text("kind")}); }},
    {"duplicate", [](Members&) -> Command { return NodeCommand(Duplicate{}); }},
    {"remove", [](Members&) -> Command { return NodeCommand(Remove{}); }},
    {"wrap", [](Members&) -> Command { return NodeCommand(Wrap{}); }},
    {"add_node", readAddNode},
    {"use_node", readUseNode},
    {"remove_at", [](Members& m) -> Command { return NodeCommand(RemoveAt{readAt(m)}); }},
    {"move_at", readMoveAt},
    {"separate_at", [](Members& m) -> Command { return NodeCommand(SeparateAt{readAt(m)}); }},
    {"set_look", readSetLook},
    {"tool", readBeginTool},
    {"tool_at", readPointTool},
    {"tool_key",
     [](Members& m) -> Command { return ToolCommand(TypeTool{text(m, "key", mostKeyBytes)}); }},
    {"end_tool",
     [](Members& m) -> Command {
       return ToolCommand(EndTool{json::switchOf(m.at("accept"), m.need("accept"))});
     }},
    {"handles", [](Members&) -> Command { return ToolCommand(NextHandles{}); }},
    {"probe", readPutProbe},
    {"measure",
     [](Members& m) -> Command {
       const Place begin = from(m);
       return LightCommand(Measure{begin, to(m)});
     }},
    {"keep_probes", [](Members&) -> Command { return LightCommand(KeepProbes{}); }},
    {"clear_probes", [](Members&) -> Command { return LightCommand(ClearProbes{}); }},
    {"compare", readCompare},
    {"point",
     [](Members& m) -> Command {
       const bool rests = m.has("x") || m.has("y");
       return LightCommand(PointAt{rests ? std::optional(place(m)) : std::nullopt});
     }},
    {"keep_in_world", [](Members& m) -> Command { return LightCommand(KeepInWorld{probe(m)}); }},
    {"name_probe",
     [](Members& m) -> Command {
       const int number = probe(m);
       return LightCommand(NameProbe{number, text(m, "name", mostNameBytes)});
     }},
    {"show_sensors", [](Members&) -> Command { return LightCommand(ShowSensors{}); }},
    {"probe_table", [](Members&) -> Command { return LightCommand(ProbeTable{}); }},
    {"report", [](Members&) -> Command { return LightCommand(Report{}); }},
    {"import", readImport},
    {"import_part",
     [](Members& m) -> Command {
       return FileCommand(ImportPart{text(m, "data", size_t(maxEditBytes))});
     }},
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
