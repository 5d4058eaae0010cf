#include "session/input/world_keys.h"

#include <utility>

namespace vv {

namespace {

struct Name {
  const char *window, *world;
};
// The window's keys have the names of SDL, those of pages the names of browsers.
constexpr Name names[] = {{"Left Shift", "Shift"},  {"Right Shift", "Shift"},
                          {"Left Ctrl", "Control"}, {"Right Ctrl", "Control"},
                          {"Left Alt", "Alt"},      {"Right Alt", "Alt"},
                          {"AltGraph", "Alt"},      {"AltGr", "Alt"},
                          {"Return", "Enter"},      {"Keypad Enter", "Enter"}};

const char* worldNameOf(const std::string& key) {
  for (const Name& name : names)
    if (key == name.window) return name.world;
  return nullptr;
}

bool isPrintable(const std::string& text) {
  return text.size() == 1 && text[0] >= ' ' && text[0] <= '~';
}

// A key as the sensors of the world name it.
struct KeyForWorld {
  std::string name;
  bool isText;  // its character comes as an event of its own
  bool isTyped; // it types a character, or is Enter, Backspace or Tab

  explicit KeyForWorld(const InputEvent& event) {
    const char* const named = worldNameOf(event.text);
    const std::string typed = typedBy(event);
    name = named ? named : typed.empty() ? event.text : typed;
    isText = typed.empty() && (isPrintable(name) || static_cast<signed char>(name[0]) < 0);
    isTyped = !typed.empty() || name == "Enter" || name == "Backspace" || name == "Tab";
  }
};

} // namespace

std::string typedBy(const InputEvent& event) {
  if (event.control || event.alt) return {};
  std::string key = event.text;
  if (key == "Space") key = " ";
  if (key.size() == 8 && key.starts_with("Keypad ")) key.erase(0, 7);
  if (!isPrintable(key)) return {};
  if (key[0] >= 'A' && key[0] <= 'Z')
    return event.shift ? key : std::string(1, char(key[0] - 'A' + 'a'));
  return event.shift && key != " " ? std::string() : key;
}

WorldKeys::Claim WorldKeys::claimOf(const xvrml::Browser& browser, const InputEvent& event) {
  if (!browser.sensesKeys()) return Claim::window;
  const KeyForWorld key(event);
  if (key.isText) return event.control ? Claim::window : Claim::world;
  return key.isTyped ? Claim::world : Claim::both;
}

bool WorldKeys::press(xvrml::Browser& browser, const InputEvent& event) {
  if (!browser.sensesKeys()) return false;
  const KeyForWorld key(event);
  if (key.isText) return !event.control;
  if (!browser.worldKey(key.name, true)) return false;
  pressed_[event.text] = key.name;
  return key.isTyped;
}

void WorldKeys::release(xvrml::Browser& browser, const InputEvent& event) {
  const auto found = pressed_.find(event.text);
  if (found == pressed_.end()) return;
  browser.worldKey(found->second, false);
  pressed_.erase(found);
}

void WorldKeys::release(xvrml::Browser& browser) {
  for (const auto& [key, name] : std::exchange(pressed_, {})) browser.worldKey(name, false);
}

InputEvent WorldKeys::commandOf(const xvrml::Browser& browser, const InputEvent& event) {
  InputEvent command = event;
  if (browser.sensesKeys()) command.control = false;
  return command;
}

} // namespace vv
