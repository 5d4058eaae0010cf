#include "session/input/keys.h"

#include <algorithm>

#include <fmt/format.h>

namespace vv {

namespace {

constexpr KeyInfo keys[] = {
    {Action::firstViewpoint, "Home", "first viewpoint"},
    {Action::lastViewpoint, "End", "last viewpoint"},
    {Action::previousViewpoint, "PageUp [", "previous viewpoint"},
    {Action::nextViewpoint, "PageDown ]", "next viewpoint"},
    {Action::back, "Backspace", "return to the viewpoint"},
    {Action::frameAll, "F", "frame all: the whole world in view"},
    {Action::examine, "1", "examine: turn the world around"},
    {Action::walk, "2", "walk, on the ground and not through walls"},
    {Action::fly, "3", "fly"},
    {Action::still, "4", "no navigation: the mouse works only sensors and anchors"},
    {Action::none, "Left Right Up Down", "turn and go; Shift: faster; Alt: sideways, up and down"},
    {Action::headlight, "H", "headlight on or off"},
    {Action::brighter, "+ =", "brighter by half a stop"},
    {Action::darker, "-", "darker by half a stop"},
    {Action::falseColours, "L", "luminance in false colours, or the picture's own colours"},
    {Action::pause, "P", "pause or resume time"},
    {Action::save, "S", "save the picture as PNG"},
    {Action::saveExr, "Shift+S", "save the picture as OpenEXR"},
    {Action::samples, "N", "raw samples or rebuilt pictures while something moves"},
    {Action::command, "C", "print the vv command that makes a picture of this view"},
    {Action::reload, "R", "reload the world and keep the view"},
    {Action::overlay, "I", "information about the picture: none, brief, all"},
    {Action::edit, "E", "editor: open or close its panels"},
    {Action::help, "F1 ?", "this text"},
    {Action::fullScreen, "F11", "full screen"},
    {Action::quit, "Q Escape", "quit"},
};

constexpr MouseInfo mouse[] = {
    {"pointer", "a hand over a sensor or an anchor; a drag then works the sensor"},
    {"left drag", "examine: turn; walk, fly: go and turn, faster with a longer drag"},
    {"right or Shift drag", "examine: move aside; walk, fly: sideways, up and down"},
    {"middle or Ctrl drag", "examine: nearer and farther; walk, fly: look around"},
    {"wheel", "move nearer and farther"},
    {"drop of a file", "opens it"},
};

bool matches(std::string_view one, const InputEvent& event) {
  const bool shifted = one.starts_with("Shift+");
  if (shifted) one.remove_prefix(6);
  const bool letter = one.size() == 1 && one[0] >= 'A' && one[0] <= 'Z';
  return one == event.text && (!letter || shifted == event.shift) && !event.control && !event.alt;
}

} // namespace

std::span<const KeyInfo> keyTable() { return keys; }
std::span<const MouseInfo> mouseTable() { return mouse; }

Action actionOf(const InputEvent& event) {
  for (const KeyInfo& info : keys) {
    std::string_view rest = info.keys;
    while (!rest.empty()) {
      const size_t blank = std::min(rest.find(' '), rest.size());
      if (matches(rest.substr(0, blank), event)) return info.action;
      rest.remove_prefix(std::min(blank + 1, rest.size()));
    }
  }
  return Action::none;
}

std::string listKeys() {
  std::string out;
  for (const KeyInfo& info : keys) {
    std::string names;
    for (const char* at = info.keys; *at; ++at)
      names += *at == ' ' ? std::string(", ") : std::string(1, *at);
    out += keyLine(names, info.text);
  }
  for (const MouseInfo& info : mouse) out += keyLine(info.what, info.text);
  return out;
}

std::string keyLine(std::string_view keys, std::string_view text) {
  return fmt::format("{:<24}{}\n", keys, text);
}

} // namespace vv
