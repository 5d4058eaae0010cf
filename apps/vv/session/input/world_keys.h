// world_keys.h: Passes keys to the KeySensor or StringSensor of the world. While one is enabled it
// gets all keys. Those that type a character, Enter, Tab, Backspace and Space are then no commands
// of the window, unless Ctrl is held; arrows, Home, End, PageUp, PageDown, Escape and F keys do
// both. [the browser's thread]
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "session/input/input.h"
#include "xvrml/browser.h"

namespace vv {

// Returns the character that a key types by itself: that of a letter, or of another key without
// Shift; "" with Alt or Ctrl, and for keys that type none. Everything else that the user types
// comes as text.
std::string typedBy(const InputEvent& event);

class WorldKeys {
 public:
  // Whom a key that goes down is for: the window alone, both, or the world alone.
  enum class Claim : uint8_t { window, both, world };
  // Tells whom a key is for, if the sensor takes it. Passes nothing on.
  static Claim claimOf(const xvrml::Browser& browser, const InputEvent& event);
  // Passes a key that goes down. Returns whether it is the world's alone.
  bool press(xvrml::Browser& browser, const InputEvent& event);
  // Releases the key as it was pressed, whatever Shift is now.
  void release(xvrml::Browser& browser, const InputEvent& event);
  void release(xvrml::Browser& browser); // releases all keys
  // Returns the event whose command the window runs: while a sensor is enabled, Ctrl and a letter
  // mean the letter.
  static InputEvent commandOf(const xvrml::Browser& browser, const InputEvent& event);

 private:
  std::map<std::string, std::string> pressed_; // the world's names by those of the window
};

} // namespace vv
