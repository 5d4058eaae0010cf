// replay.h: a world driven by a script: steps of 1/fps from 0, and the script's events at the steps
// that they fall on. The same script gives the same world, with a window or without. [the browser's
// thread]
#pragma once

#include <functional>

#include "window/input/input_script.h"
#include "window/pilot.h"

namespace vv {

class Replay {
 public:
  // business: gets what Pilot::handle leaves to the window.
  Replay(Pilot& pilot, const InputScript& script,
         std::function<void(const InputEvent&, Action)> business)
      : pilot_(pilot), script_(script), business_(std::move(business)) {}

  // The clock has come to `time`; its events happen. False while wait() holds: call it again with
  // the same time.
  bool step(double time);
  // The events after this one wait for resume().
  void wait() { waiting_ = true; }
  void resume() { waiting_ = false; }
  bool finished() const { return next_ >= script_.events.size(); }

 private:
  Pilot& pilot_;
  const InputScript& script_;
  std::function<void(const InputEvent&, Action)> business_;
  size_t next_ = 0;
  double stepped_ = -1;
  bool waiting_ = false;
};

} // namespace vv
