// input.h: what a hand does to the window, without any windowing system: made from SDL's events
// (window.cpp) or from a script (input_script.h), understood by Pilot and Window. [plain data]
#pragma once

#include <cstdint>
#include <string>

namespace vv {

enum class Button : uint8_t { left, middle, right };

struct InputEvent {
  enum class Kind : uint8_t {
    move,      // the pointer is at x, y
    press,     // button, at x, y
    release,   // button, at x, y
    leave,     // the pointer is outside, or the window has lost it
    wheel,     // amount: notches, away from the user
    down,      // key
    up,        // key
    viewpoint, // text: name, description or number from 0
    save,      // text: file
    open,      // text: file
    quit
  };
  Kind kind = Kind::move;
  double x = 0, y = 0; // in the picture, from -1 at the left and bottom to 1 at the right and top
  Button button = Button::left;
  double amount = 0;
  std::string text; // of a key its name: "PageUp", "Left", "A", "["
  bool shift = false, control = false, alt = false;
};

} // namespace vv
