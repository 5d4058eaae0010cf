#include "session/input/replay.h"

namespace vv {

bool Replay::step(double time) {
  if (waiting_) return false;
  if (time != stepped_) pilot_.step(time);
  stepped_ = time;
  while (!finished() && script_.events[next_].time <= time) {
    const InputEvent& event = script_.events[next_++].event;
    if (const Action action = pilot_.handle(event); action != Action::none)
      onAction_(event, action);
    if (waiting_) return false;
  }
  return true;
}

} // namespace vv
