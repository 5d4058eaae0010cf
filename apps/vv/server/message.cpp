#include "server/message.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/limits.h"

namespace vv::server {

namespace {

using Json = nlohmann::json;
using Kind = InputEvent::Kind;

// Leaves readMessage(), which returns its text.
struct Fault : std::runtime_error {
  using runtime_error::runtime_error;
};

// Refuses objects with two members of a name, and anything inside the outer object but plain
// values. Both would be lost or cost time in a tree.
class FlatObject final : public nlohmann::json_sax<Json> {
 public:
  Json object = Json::object();

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override { return put(value); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override {
    if (depth_++ > 0) throw Fault("a plain value was expected, not an object");
    return true;
  }
  bool key(string_t& name) override {
    name_ = name;
    if (object.contains(name)) throw Fault("a name occurs twice");
    return true;
  }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override {
    throw Fault("a plain value was expected, not an array");
  }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    throw Fault("it is no JSON");
  }

 private:
  template <class Value> bool put(Value value) {
    if (depth_ == 0) throw Fault("an object was expected");
    object[name_] = std::move(value);
    return true;
  }

  int depth_ = 0;
  std::string name_;
};

// Takes the members of a message one by one. A member that is left at the end is one too many.
class Members {
 public:
  explicit Members(Json object) : object_(std::move(object)) {}

  std::string text(const char* name, size_t longest) {
    const Json value = take(name);
    if (!value.is_string()) throw Fault(fmt::format("{}: a text was expected", name));
    const auto& read = value.get_ref<const std::string&>();
    if (read.empty() || read.size() > longest)
      throw Fault(fmt::format("{}: 1 to {} bytes were expected", name, longest));
    return read;
  }
  double number(const char* name, double least, double most) {
    const Json value = take(name);
    if (!value.is_number()) throw Fault(fmt::format("{}: a number was expected", name));
    const double read = value.get<double>();
    if (!(read >= least && read <= most))
      throw Fault(fmt::format("{}: a number from {} to {} was expected", name, least, most));
    return read;
  }
  int64_t integer(const char* name, int64_t least, int64_t most) {
    const double read = number(name, double(least), double(most));
    if (read != std::floor(read)) throw Fault(fmt::format("{}: a whole number was expected", name));
    return int64_t(read);
  }
  // A missing switch is off.
  bool flag(const char* name) {
    if (!object_.contains(name)) return false;
    const Json value = take(name);
    if (!value.is_boolean()) throw Fault(fmt::format("{}: true or false was expected", name));
    return value.get<bool>();
  }
  // Returns the place of a text in a list of allowed ones.
  size_t choice(const char* name, std::span<const std::string_view> allowed) {
    const std::string read = text(name, 32);
    for (size_t i = 0; i < allowed.size(); ++i)
      if (read == allowed[i]) return i;
    throw Fault(fmt::format("{}: one of {} was expected", name, fmt::join(allowed, ", ")));
  }
  void end() const {
    if (!object_.empty()) throw Fault("there are more members than its type has");
  }

 private:
  Json take(const char* name) {
    const auto found = object_.find(name);
    if (found == object_.end()) throw Fault(fmt::format("{}: it is missing", name));
    Json value = std::move(*found);
    object_.erase(found);
    return value;
  }

  Json object_;
};

constexpr std::array<std::string_view, 14> types = {
    "size", "shown", "move",      "press", "release", "leave", "wheel",
    "down", "up",    "viewpoint", "own",   "follow",  "save",  "command"};
constexpr std::array<std::string_view, 3> buttons = {"left", "middle", "right"};
constexpr std::array<std::string_view, 2> formats = {"png", "exr"};

// A drag may leave the picture, where coordinates go from -1 to 1.
constexpr double farthest = 100;
constexpr double mostNotches = 100;

void readModifiers(Members& from, InputEvent& event) {
  event.shift = from.flag("shift");
  event.control = from.flag("ctrl");
  event.alt = from.flag("alt");
}

Message inputOf(Kind kind, Members& from) {
  Message message;
  InputEvent& event = message.input;
  event.kind = kind;
  switch (kind) {
  case Kind::press:
  case Kind::release:
    event.button = Button(from.choice("button", buttons));
    readModifiers(from, event);
    [[fallthrough]];
  case Kind::move:
    event.x = from.number("x", -farthest, farthest);
    event.y = from.number("y", -farthest, farthest);
    break;
  case Kind::wheel: event.amount = from.number("amount", -mostNotches, mostNotches); break;
  case Kind::down:
  case Kind::up:
    event.text = from.text("key", 16);
    for (const char c : event.text)
      if (c < ' ' || c > '~') throw Fault("key: printable ASCII was expected");
    readModifiers(from, event);
    break;
  default: break;
  }
  return message;
}

Message messageOf(std::string_view type, Members& from) {
  using Type = Message::Type;
  constexpr std::pair<std::string_view, Kind> inputs[] = {
      {"move", Kind::move},   {"press", Kind::press}, {"release", Kind::release},
      {"leave", Kind::leave}, {"wheel", Kind::wheel}, {"down", Kind::down},
      {"up", Kind::up}};
  for (const auto& [name, kind] : inputs)
    if (name == type) return inputOf(kind, from);
  Message message;
  if (type == "size") {
    message.type = Type::size;
    message.width = int(from.integer("width", 1, 65536));
    message.height = int(from.integer("height", 1, 65536));
  } else if (type == "shown") {
    message.type = Type::shown;
    message.picture = uint32_t(from.integer("picture", 1, std::numeric_limits<uint32_t>::max()));
  } else if (type == "viewpoint") {
    message.type = Type::viewpoint;
    message.number = int(from.integer("number", 0, 1'000'000));
  } else if (type == "save") {
    message.type = Type::save;
    message.format = Message::Format(from.choice("format", formats));
  } else {
    message.type = type == "own" ? Type::own : type == "follow" ? Type::follow : Type::command;
  }
  return message;
}

// Reads the message of a page that may edit; none: it is no edit.
std::optional<Message> readEdit(std::string_view text) {
  const json::LineLimits allowed{maxEditBytes, maxEditDepth, maxEditValues};
  Json object = json::readJsonLine(text, allowed);
  const auto type = object.find("type");
  if (type == object.end() || *type != "edit") return {};
  Message message;
  message.type = Message::Type::edit;
  message.editCommand = edit::readCommand(std::move(object));
  return message;
}

} // namespace

ReadMessage readMessage(std::string_view text, Rights rights) {
  try {
    // The parser takes this for the end of the text.
    if (text.find('\0') != text.npos) throw Fault("it is no JSON");
    if (rights == Rights::edit)
      if (std::optional<Message> edit = readEdit(text)) return {std::move(edit), {}};
    if (text.size() > size_t(maxMessageBytes))
      throw Fault(fmt::format("it is longer than maxMessageBytes ({})", maxMessageBytes));
    FlatObject reader;
    if (!Json::sax_parse(text.begin(), text.end(), &reader)) throw Fault("it is no JSON");
    Members members(std::move(reader.object));
    const std::string_view type = types[members.choice("type", types)];
    Message message = messageOf(type, members);
    members.end();
    return {std::move(message), {}};
  } catch (const Fault& fault) {
    return {std::nullopt, fault.what()};
  } catch (const json::CommandError& error) { return {std::nullopt, error.what()}; }
}

} // namespace vv::server
