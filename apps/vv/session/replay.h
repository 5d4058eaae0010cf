// replay.h: Drives a world with a script: steps of 1/fps from 0, with the script's events at their
// steps, in the order of step_order.h. The same script gives the same world, with or without a
// window. [the browser's thread]
#pragma once

#include <functional>

#include "session/input/input_script.h"
#include "session/input/step_order.h"
#include "session/pilot.h"

namespace vv {

class Replay {
 public:
  // onAction: receives the actions that Pilot::handle leaves to the window.
  Replay(Pilot& pilot, const InputScript& script,
         std::function<void(const InputEvent&, Action)> onAction)
      : pilot_(pilot), script_(script), onAction_(std::move(onAction)) {}

  // Advances the clock to `time` and plays its events. Returns false while wait() is in effect;
  // call it again with the same time then.
  bool step(double time);
  // Holds back the events after this one until resume().
  void wait() { waiting_ = true; }
  void resume() { waiting_ = false; }
  bool finished() const { return next_ >= script_.events.size(); }

 private:
  Pilot& pilot_;
  const InputScript& script_;
  std::function<void(const InputEvent&, Action)> onAction_;
  size_t next_ = 0;
  StepOrder order_;
  double stepped_ = -1;
  bool waiting_ = false;
};

} // namespace vv
