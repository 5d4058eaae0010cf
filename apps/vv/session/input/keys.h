// keys.h: Defines the window's keys in one table. Pilot and Window use it, and F1, vv --list-keys
// and docs/window.md show it. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "session/input/input.h"

namespace vv {

enum class Action : uint8_t {
  none,
  firstViewpoint,
  lastViewpoint,
  previousViewpoint,
  nextViewpoint,
  back,
  frameAll,
  beginAgain, // Shows the initial view of a world without a Viewpoint; it has no key of its own.
  examine,
  walk,
  fly,
  still,
  headlight,
  brighter,
  darker,
  falseColours,
  pause,
  save,
  saveExr,
  samples, // raw samples or rebuilt pictures
  command,
  reload,
  overlay,
  edit,
  help,
  fullScreen,
  quit
};

struct KeyInfo {
  Action action;
  const char* keys; // separated by blanks; the prefix "Shift+" means with shift
  const char* text;
};
std::span<const KeyInfo> keyTable();

// Returns the action for a key that goes down.
Action actionOf(const InputEvent& event);

struct MouseInfo {
  const char* what;
  const char* text;
};
std::span<const MouseInfo> mouseTable();

std::string listKeys(); // for people: keys, then the mouse
// Returns a line of such a list.
std::string keyLine(std::string_view keys, std::string_view text);

} // namespace vv
