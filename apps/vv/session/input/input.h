// input.h: Represents user input independently of the windowing system. window.cpp makes it from
// SDL's events, input_script.h from a script; Pilot and Window consume it. [plain data]
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
    leave,     // the pointer has left the window, or the window has lost it
    wheel,     // amount: notches, away from the user
    down,      // the key `text` goes down
    up,        // the key `text` goes up
    type,      // `text` is typed for the world's sensors alone
    viewpoint, // go to the viewpoint `text`: a name, a description or a number from 0
    save,      // save the picture to the file `text`
    open,      // open the file `text`
    quit
  };
  Kind kind = Kind::move;
  // picture coordinates from -1 at the left and bottom to 1 at the right and top
  double x = 0, y = 0;
  Button button = Button::left;
  double amount = 0;
  std::string text; // name of a key: "PageUp", "Left", "A", "["
  bool shift = false, control = false, alt = false;
  bool forView = false; // the button moves the viewer, although it is pressed over a sensor
};

} // namespace vv
