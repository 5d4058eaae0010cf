// input_script.h: what a hand did, as a text: --input plays it, --record-input writes it down. One
// event a line, in the order of their times: `SECONDS EVENT ...`, # begins a comment. An event
// happens at the first step of the clock that is not before it.
//   move X Y; press|release left|middle|right [X Y] [shift] [ctrl] [alt]; leave; wheel NOTCHES;
//   key|down|up NAME [shift ...] (key: down and up); viewpoint NAME; save FILE; quit; end (nothing:
//   the script is that long)
// X, Y: from -1 at the left and bottom to 1 at the right and top of the picture.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "window/input/input.h"

namespace vv {

struct TimedInput {
  double time = 0; // seconds since the world began
  InputEvent event;
};

struct InputScript {
  std::vector<TimedInput> events;
  double end = 0; // time of the last line
};

// Throws UsageError with the file's name and line.
InputScript readInputScript(const std::string& path);
InputScript parseInputScript(std::string_view text, const std::string& name);

// A line of a script, with its line feed.
std::string inputLine(double time, const InputEvent& event);

} // namespace vv
