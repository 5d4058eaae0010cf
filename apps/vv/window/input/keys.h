// keys.h: the window's keys: one table that Pilot and Window obey, and that F1, vv --list-keys and
// docs/window.md show. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "window/input/input.h"

namespace vv {

enum class Action : uint8_t {
  none,
  firstViewpoint,
  lastViewpoint,
  previousViewpoint,
  nextViewpoint,
  back,
  frameAll,
  beginAgain, // the view that a world without Viewpoint begins with; no key of its own
  examine,
  walk,
  fly,
  still,
  headlight,
  pause,
  save,
  saveExr,
  command,
  reload,
  overlay,
  help,
  fullScreen,
  quit
};

struct KeyInfo {
  Action action;
  const char* keys; // separated by blanks; "Shift+" in front: with shift
  const char* text;
};
std::span<const KeyInfo> keyTable();

// Of a key that goes down.
Action actionOf(const InputEvent& event);

struct MouseInfo {
  const char* what;
  const char* text;
};
std::span<const MouseInfo> mouseTable();

std::string listKeys(); // for people: keys, then the mouse

} // namespace vv
