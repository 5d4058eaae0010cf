#include "control/command.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "nearest.h"

namespace vv::control {

namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& expected, const Json& got) {
  throw CommandError("command",
                     fmt::format("{}: {} was expected, not {}", where, expected, shownJson(got)));
}

std::string nearTo(const std::string& name, const std::vector<std::string>& known) {
  constexpr size_t longest = 64; // the search takes time that grows with the name
  const std::string near = name.size() > longest ? "" : nearest::word(name, known);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

// --- Values of members ---

std::string textOf(const std::string& where, const Json& json) {
  if (!json.is_string()) refuse(where, "a text", json);
  return json.get<std::string>();
}

bool switchOf(const std::string& where, const Json& json) {
  if (!json.is_boolean()) refuse(where, "true or false", json);
  return json.get<bool>();
}

int wholeNumberOf(const std::string& where, const Json& json, int most) {
  const std::string expected = fmt::format("a whole number from 1 to {}", most);
  if (!json.is_number_integer() || json < 1 || json > most) refuse(where, expected, json);
  return json.get<int>();
}

double secondsOf(const std::string& where, const Json& json, double most) {
  if (!json.is_number() || !(json.get<double>() >= 0 && json.get<double>() <= most))
    refuse(where, fmt::format("seconds from 0 to {}", most), json);
  return json.get<double>();
}

NodeName nodeOf(const std::string& where, const Json& json) {
  if (json.is_number_unsigned()) return json.get<uint64_t>();
  if (json.is_string()) return json.get<std::string>();
  refuse(where, "the DEF name or the number of a node", json);
}

template <class T, class Read>
std::vector<T> listOf(const std::string& where, const Json& json, const Read& read) {
  if (!json.is_array()) refuse(where, "an array", json);
  std::vector<T> list;
  for (size_t i = 0; i < json.size(); ++i)
    list.push_back(read(fmt::format("{}[{}]", where, i), json[i]));
  return list;
}

// Reads the path of a file. The system would cut it off at a zero byte.
std::string pathOf(const std::string& where, const Json& json) {
  std::string path = textOf(where, json);
  if (path.empty() || path.find('\0') != path.npos) refuse(where, "the path of a file", json);
  return path;
}

// Reads one path, or an array of them.
std::vector<std::string> pathsOf(const std::string& where, const Json& json) {
  if (json.is_string()) return {pathOf(where, json)};
  return listOf<std::string>(where, json, pathOf);
}

// Reads one text, or an array of them.
std::vector<std::string> textsOf(const std::string& where, const Json& json) {
  if (json.is_string()) return {json.get<std::string>()};
  return listOf<std::string>(where, json, textOf);
}

// Reads ["Clock", "fraction_changed"].
FieldName endOf(const std::string& where, const Json& json) {
  if (!json.is_array() || json.size() != 2)
    refuse(where, "an array of a node and the name of its event", json);
  return {nodeOf(where + "[0]", json[0]), textOf(where + "[1]", json[1])};
}

// --- Commands ---

// Takes the members of an object one by one. rest() refuses those that nobody has asked for.
class Members {
 public:
  Members(std::string where, Json object) : where_(std::move(where)), object_(std::move(object)) {}

  bool has(const char* name) {
    known_.emplace_back(name);
    return object_.contains(name);
  }
  // Throws if the member is missing.
  Json& need(const char* name) {
    if (!has(name))
      throw CommandError("command", fmt::format("{}: the member \"{}\" is missing", where_, name));
    return object_[name];
  }
  std::string at(const char* name) const { return fmt::format("{}: {}", where_, name); }
  FieldName field() {
    return {nodeOf(at("node"), need("node")), textOf(at("field"), need("field"))};
  }
  std::string text(const char* name) { return textOf(at(name), need(name)); }
  Json& object() { return object_; }
  const std::string& where() const { return where_; }

  void rest() {
    for (const auto& [name, value] : object_.items())
      if (std::find(known_.begin(), known_.end(), name) == known_.end())
        throw CommandError("command", fmt::format("{}: there is no member {}{}", where_,
                                                  shownJson(name), nearTo(name, known_)));
  }

 private:
  std::string where_;
  Json object_;
  std::vector<std::string> known_;
};

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
    if (!values[i].is_object()) refuse(where, "an object", values[i]);
    Members one(where, std::move(values[i]));
    set.values.push_back({one.field(), std::move(one.need("value"))});
    one.rest();
  }
  return set;
}

Action readRender(Members& m) {
  Render render;
  if (m.has("size")) {
    const Json& size = m.need("size");
    if (!size.is_array() || size.size() != 2)
      refuse(m.at("size"), "an array of width and height", size);
    render.width = wholeNumberOf(m.at("size[0]"), size[0], limits.side);
    render.height = wholeNumberOf(m.at("size[1]"), size[1], limits.side);
    if (size_t(*render.width) * size_t(*render.height) > limits.pixels)
      throw CommandError("limit", fmt::format("{}: a picture has at most pixels={} pixels",
                                              m.at("size"), limits.pixels));
  }
  if (m.has("samples"))
    render.samples = wholeNumberOf(m.at("samples"), m.need("samples"), limits.samples);
  if (m.has("channels")) render.channels = textsOf(m.at("channels"), m.need("channels"));
  if (m.has("file")) render.file = pathOf(m.at("file"), m.need("file"));
  if (m.has("format")) render.format = m.text("format");
  return render;
}

Action readTime(Members& m) {
  Time time;
  if (m.has("paused")) time.paused = switchOf(m.at("paused"), m.need("paused"));
  if (m.has("skip")) time.skip = secondsOf(m.at("skip"), m.need("skip"), limits.skip);
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
    {"quit", [](Members&) -> Action { return Quit{}; }},
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

std::string shownNode(const NodeName& name) {
  if (const auto* number = std::get_if<uint64_t>(&name)) return fmt::format("node {}", *number);
  return "node " + shownJson(std::get<std::string>(name));
}

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
