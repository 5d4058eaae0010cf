// input_script.h: Parses and writes user input as text: --input plays it, --record-input writes it.
// Each line is one event, `SECONDS EVENT ...`, in the order of time; # begins a comment. An event
// takes effect at the first step of the clock at or after its time. The events are:
//
//   move X Y
//   press|release left|middle|right [X Y] [shift] [ctrl] [alt]
//   leave
//   wheel NOTCHES
//   key|down|up NAME [shift ...]   (key: down and up)
//   type TEXT                      (in quotation marks if it has blanks; for the world's sensors)
//   viewpoint NAME
//   save FILE
//   quit
//   end                            (no effect: sets the length of the script)
//
// X and Y go from -1 at the left and bottom to 1 at the right and top of the picture.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "session/input/input.h"

namespace vv {

struct TimedInput {
  double time = 0; // seconds since the start of the world
  InputEvent event;
};

struct InputScript {
  std::vector<TimedInput> events;
  double end = 0; // time of the last line
};

// Throws Failure with exitInput; its text has the file's name and the line.
InputScript readInputScript(const std::string& path);
// Throws UsageError with `name` and the line.
InputScript parseInputScript(std::string_view text, const std::string& name);

// Returns a line of a script, with its line feed.
std::string inputLine(double time, const InputEvent& event);

} // namespace vv
