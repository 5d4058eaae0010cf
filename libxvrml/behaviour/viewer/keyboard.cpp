// keyboard.cpp: the events of KeySensor and StringSensor, and which of them is active.
#include "behaviour/viewer/keyboard.h"

#include <algorithm>

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// The numbers of ISO/IEC 19775-1 table 21.2.
struct ActionKey {
  std::string_view name;
  int32_t number;
};
constexpr ActionKey actionKeys[] = {{"F1", 1},    {"F2", 2},    {"F3", 3},      {"F4", 4},
                                    {"F5", 5},    {"F6", 6},    {"F7", 7},      {"F8", 8},
                                    {"F9", 9},    {"F10", 10},  {"F11", 11},    {"F12", 12},
                                    {"Home", 13}, {"End", 14},  {"PageUp", 15}, {"PageDown", 16},
                                    {"Up", 17},   {"Down", 18}, {"Left", 19},   {"Right", 20}};

struct Modifier {
  std::string_view name;
  void (*send)(Events& events, Node& node, Value pressed);
};
constexpr Modifier modifiers[] = {{"Shift", sendFrom<"shiftKey">},
                                  {"Control", sendFrom<"controlKey">},
                                  {"Alt", sendFrom<"altKey">}};

struct NamedCharacter {
  std::string_view name, text;
};
constexpr NamedCharacter characters[] = {{"Enter", "\n"},    {"Backspace", "\b"}, {"Tab", "\t"},
                                         {"Escape", "\x1b"}, {"Delete", "\x7f"},  {"Space", " "}};

template <class Table> auto findNamed(const Table& table, std::string_view name) {
  const auto found = std::find_if(std::begin(table), std::end(table),
                                  [&](const auto& one) { return one.name == name; });
  return found == std::end(table) ? nullptr : &*found;
}

// Returns the character of a key; "" if the name is no key that types one.
std::string_view characterOf(std::string_view name) {
  if (const auto* named = findNamed(characters, name)) return named->text;
  const bool one = !name.empty() && utf8Length(name) == name.size() && uint8_t(name[0]) != 0;
  // A single byte beyond ASCII is a part of a character.
  return one && (name.size() > 1 || uint8_t(name[0]) < 0x80) ? name : std::string_view();
}

struct State : NodeState {
  bool active = false;
  std::string typed; // for a StringSensor
};

State& stateOf(Events& events, Node& node) { return static_cast<State&>(*events.state(node)); }

bool keySensor(Events& events, Node& node, std::string_view name, bool pressed) {
  if (const auto* action = findNamed(actionKeys, name)) {
    if (pressed)
      sendFrom<"actionKeyPress">(events, node, action->number);
    else
      sendFrom<"actionKeyRelease">(events, node, action->number);
    return true;
  }
  if (const auto* modifier = findNamed(modifiers, name)) {
    modifier->send(events, node, pressed);
    return true;
  }
  const std::string_view text = characterOf(name);
  if (text.empty()) return false;
  if (pressed)
    sendFrom<"keyPress">(events, node, std::string(text));
  else
    sendFrom<"keyRelease">(events, node, std::string(text));
  return true;
}

// Enter ends the text, and the next one begins empty.
bool stringSensor(Events& events, Node& node, std::string_view name, bool pressed) {
  constexpr size_t longest = 65'536;
  const std::string_view text = characterOf(name);
  if (text.empty())
    return findNamed(actionKeys, name) || findNamed(modifiers, name); // they type nothing
  if (!pressed) return true;
  std::string& typed = stateOf(events, node).typed;
  if (text == "\n") {
    sendFrom<"finalText">(events, node, std::exchange(typed, {}));
  } else if (text == "\b") {
    if (!static_cast<nodes::StringSensor&>(node).deletionAllowed || typed.empty()) return true;
    do typed.pop_back();
    while (!typed.empty() && (uint8_t(typed.back()) & 0xc0) == 0x80);
    if (!typed.empty() && uint8_t(typed.back()) >= 0xc0) typed.pop_back();
  } else {
    const bool types = uint8_t(text[0]) >= ' ' && text != "\x7f";
    if (!types || typed.size() + text.size() > longest) return true;
    typed += text;
  }
  sendFrom<"enteredText">(events, node, typed);
  return true;
}

} // namespace

size_t utf8Length(std::string_view text) {
  const uint8_t first = uint8_t(text[0]);
  const size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1;
  if (bytes > text.size()) return 1;
  for (size_t i = 1; i < bytes; ++i)
    if ((uint8_t(text[i]) & 0xc0) != 0x80) return 1;
  return bytes;
}

bool Keyboard::senses() const { return active_ && isInScene(*active_); }

bool Keyboard::key(std::string_view name, bool pressed) {
  if (!senses()) return false;
  return active_->type().index == nodes::KeySensor::typeIndex
             ? keySensor(engine_, *active_, name, pressed)
             : stringSensor(engine_, *active_, name, pressed);
}

void Keyboard::activate(Node& sensor) {
  Node* const before = std::exchange(active_, &sensor);
  if (before && before != &sensor) engine_.post(*before, *fieldNamed<"enabled">(*before), false);
}

void Keyboard::deactivate(Node& sensor) {
  if (active_ == &sensor) active_ = nullptr;
}

void Keyboard::forget(const Node& node) {
  if (active_ == &node) active_ = nullptr;
}

namespace {

bool isEnabled(const Node& node) {
  return *static_cast<const SFBool*>(node.storage(*fieldNamed<"enabled">(node)));
}

// A sensor is active while it is enabled (21.2).
void setActive(Events& events, Node& node, State& state, bool active) {
  if (std::exchange(state.active, active) == active) return;
  state.typed.clear();
  Keyboard& keyboard = interactionOf(events).keyboard;
  if (active)
    keyboard.activate(node);
  else
    keyboard.deactivate(node);
  sendFrom<"isActive">(events, node, active);
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  auto state = std::make_unique<State>();
  if (isEnabled(node)) setActive(events, node, *state, true);
  return state;
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  if (isField<"enabled">(node, in))
    setActive(events, node, stateOf(events, node), std::get<bool>(value));
}

} // namespace

void addKeySensorBehaviours(const AddBehaviour& add) {
  for (const NodeType* type : {&nodes::KeySensor::nodeType(), &nodes::StringSensor::nodeType()})
    add(*type, {.begin = begin, .receive = receive});
}

} // namespace xvrml
