#include "control/command.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "as_json/members.h"

namespace vv::control {

namespace {

// Reads ["Clock", "fraction_changed"].
FieldName endOf(const std::string& where, const Json& json) {
  if (!json.is_array() || json.size() != 2)
    refuse(where, "an array of a node and the name of its event", json);
  return {nodeOf(where + "[0]", json[0]), textOf(where + "[1]", json[1])};
}

bool readSwitch(Members& m, const char* name, bool otherwise) {
  return m.has(name) ? switchOf(m.at(name), m.need(name)) : otherwise;
}

Action readSet(Members& m) {
  Set set;
  if (!m.has("values")) {
    set.values.push_back({m.field(), std::move(m.need("value"))});
    return set;
  }
  Json& values = m.need("values");
  if (!values.is_array() || values.empty()) refuse(m.at("values"), "an array of objects", values);
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string where = fmt::format("{}[{}]", m.at("values"), i);
    Members one(where, std::move(values[i]));
    set.values.push_back({one.field(), std::move(one.need("value"))});
    one.rest();
  }
  return set;
}

std::optional<int> readSamples(Members& m) {
  if (!m.has("samples")) return {};
  return wholeNumberOf(m.at("samples"), m.need("samples"), 1, limits.samples);
}

Action readRender(Members& m) {
  Render render;
  if (m.has("size")) {
    const Json& size = m.need("size");
    if (!size.is_array() || size.size() != 2)
      refuse(m.at("size"), "an array of width and height", size);
    render.width = wholeNumberOf(m.at("size[0]"), size[0], 1, limits.side);
    render.height = wholeNumberOf(m.at("size[1]"), size[1], 1, limits.side);
    if (size_t(*render.width) * size_t(*render.height) > limits.pixels)
      throw CommandError("limit", fmt::format("{}: a picture has at most pixels={} pixels",
                                              m.at("size"), limits.pixels));
  }
  render.samples = readSamples(m);
  if (m.has("channels")) render.channels = textsOf(m.at("channels"), m.need("channels"));
  if (m.has("file")) render.file = pathOf(m.at("file"), m.need("file"));
  if (m.has("format")) render.format = m.text("format");
  return render;
}

Action readTime(Members& m) {
  Time time;
  if (m.has("paused")) time.paused = switchOf(m.at("paused"), m.need("paused"));
  if (m.has("skip")) time.skip = numberOf(m.at("skip"), m.need("skip"), "seconds", 0, limits.skip);
  return time;
}

Action readKey(Members& m) {
  PressKey press;
  if (m.has("text")) {
    press.text = m.text("text");
    return press;
  }
  press.key = m.text("key");
  if (m.has("pressed")) press.pressed = switchOf(m.at("pressed"), m.need("pressed"));
  return press;
}

// Reads x and y from -1 to 1.
Pick readPick(Members& m) {
  const auto read = [&](const char* name) {
    return numberOf(m.at(name), m.need(name), "a number", -1, 1);
  };
  return {read("x"), read("y")};
}

Action readProbe(Members& m) {
  Probe probe{readPick(m), readSamples(m)};
  if (!m.has("quantity")) return probe;
  const std::string quantity = m.text("quantity");
  probe.illuminance = quantity == "illuminance";
  if (!probe.illuminance && quantity != "luminance")
    refuse(m.at("quantity"), "\"luminance\" or \"illuminance\"", quantity);
  return probe;
}

Action readSave(Members& m) {
  Save save;
  if (m.has("path")) save.path = pathOf(m.at("path"), m.need("path"));
  save.overwrite = readSwitch(m, "overwrite", false);
  return save;
}

Action readBind(Members& m) {
  const Json& json = m.need("viewpoint");
  if (json.is_number_unsigned()) return Bind{json.dump()};
  if (json.is_string()) return Bind{json.get<std::string>()};
  refuse(m.at("viewpoint"), "a DEF name, a description or a number from 0", json);
}

ChangeRoute readRoute(Members& m, bool add) {
  return {endOf(m.at("from"), m.need("from")), endOf(m.at("to"), m.need("to")), add};
}

Action readRelease(Members& m) {
  return Release{listOf<uint64_t>(m.at("nodes"), m.need("nodes"),
                                  [](const std::string& where, const Json& json) {
                                    if (!json.is_number_unsigned())
                                      refuse(where, "the number of a node", json);
                                    return json.get<uint64_t>();
                                  })};
}

struct Row {
  const char* name;
  Action (*read)(Members& members);
};

constexpr Row table[] = {
    {"hello", [](Members&) -> Action { return Hello{}; }},
    {"get", [](Members& m) -> Action { return Get{m.field()}; }},
    {"set", readSet},
    {"subscribe",
     [](Members& m) -> Action {
       return Subscribe{m.field(), true};
     }},
    {"unsubscribe",
     [](Members& m) -> Action {
       return Subscribe{m.field(), false};
     }},
    {"create", [](Members& m) -> Action { return Create{m.text("vrml")}; }},
    {"add_root",
     [](Members& m) -> Action {
       return ChangeRoots{nodeOf(m.at("node"), m.need("node")), true};
     }},
    {"remove_root",
     [](Members& m) -> Action {
       return ChangeRoots{nodeOf(m.at("node"), m.need("node")), false};
     }},
    {"release", readRelease},
    {"route", [](Members& m) -> Action { return readRoute(m, true); }},
    {"unroute", [](Members& m) -> Action { return readRoute(m, false); }},
    {"node", [](Members& m) -> Action { return Describe{nodeOf(m.at("node"), m.need("node"))}; }},
    {"names", [](Members&) -> Action { return ListNames{}; }},
    {"viewpoints", [](Members&) -> Action { return ListViewpoints{}; }},
    {"bind", readBind},
    {"load", [](Members& m) -> Action { return Load{pathsOf(m.at("url"), m.need("url"))}; }},
    {"replace_world",
     [](Members& m) -> Action {
       return Replace{listOf<NodeName>(m.at("nodes"), m.need("nodes"), nodeOf)};
     }},
    {"render", readRender},
    {"time", readTime},
    {"key", readKey},
    {"edit", [](Members& m) -> Action { return edits::readStep(m, limits.edits); }},
    {"undo", [](Members&) -> Action { return Undo{false}; }},
    {"redo", [](Members&) -> Action { return Undo{true}; }},
    {"save", readSave},
    {"edits", [](Members& m) -> Action { return ListEdits{readSwitch(m, "text", false)}; }},
    {"roots", [](Members&) -> Action { return ListRoots{}; }},
    {"parents",
     [](Members& m) -> Action { return ListParents{nodeOf(m.at("node"), m.need("node"))}; }},
    {"select",
     [](Members& m) -> Action {
       return Select{listOf<NodeName>(m.at("nodes"), m.need("nodes"), nodeOf)};
     }},
    {"selection", [](Members&) -> Action { return ListSelection{}; }},
    {"parameters",
     [](Members& m) -> Action {
       return ListParameters{m.text("class"), m.has("file") ? m.text("file") : ""};
     }},
    {"pick", [](Members& m) -> Action { return readPick(m); }},
    {"probe", readProbe},
    {"measure", [](Members& m) -> Action { return Measure{readSamples(m)}; }},
    {"recover", [](Members& m) -> Action { return Recover{readSwitch(m, "use", true)}; }},
    {"quit", [](Members& m) -> Action { return Quit{readSwitch(m, "discard", false)}; }},
};

std::vector<std::string> commandNames() {
  std::vector<std::string> names;
  for (const Row& row : table) names.emplace_back(row.name);
  return names;
}

Command readCommand(Json object, std::string id) {
  Command command;
  command.id = std::move(id);
  Members outer("the line", std::move(object));
  command.name = outer.text("command");
  const Row* row = std::find_if(std::begin(table), std::end(table),
                                [&](const Row& one) { return command.name == one.name; });
  if (row == std::end(table))
    throw CommandError("command", fmt::format("there is no command {}{}", shownJson(command.name),
                                              nearTo(command.name, commandNames())));
  Members members(command.name, std::move(outer.object()));
  static_cast<void>(members.has("id"));
  static_cast<void>(members.has("command"));
  if (members.has("quiet")) command.quiet = switchOf(members.at("quiet"), members.need("quiet"));
  command.action = row->read(members);
  members.rest();
  return command;
}

// Returns the client's id as JSON text. Only texts and numbers are ids.
std::string idOf(const Json& object) {
  constexpr size_t longest = 1000;
  const auto found = object.find("id");
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_string() && !found->is_number()) refuse("id", "a number or a text", *found);
  std::string id = found->dump();
  if (id.size() > longest)
    throw CommandError("limit", fmt::format("id: it has more than {} bytes", longest));
  return id;
}

} // namespace

Line readLine(std::string_view line, const Limits& allowed) {
  Line read;
  try {
    Json json = readJsonLine(line, allowed);
    read.id = idOf(json);
    read.command = readCommand(std::move(json), read.id);
  } catch (const CommandError& error) {
    read.code = error.code;
    read.message = error.what();
  } catch (const std::bad_alloc&) {
    read.code = "limit";
    read.message = "not enough memory for the line";
  }
  return read;
}

std::string errorAnswer(const std::string& id, std::string_view code, std::string_view message) {
  return fmt::format(R"({{"id":{},"error":{{"code":{},"message":{}}}}})", id.empty() ? "null" : id,
                     jsonText(code), jsonText(message));
}

} // namespace vv::control
