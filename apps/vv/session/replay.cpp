#include "session/replay.h"

namespace vv {

bool Replay::step(double time) {
  if (waiting_) return false;
  if (time != stepped_) {
    pilot_.step(time);
    order_.begin();
  }
  stepped_ = time;
  while (!finished() && script_.events[next_].time <= time) {
    const InputEvent& event = script_.events[next_].event;
    const bool apart = order_.isEnded();
    const Action action = apart ? pilot_.windowAction(event) : pilot_.handle(event);
    if (apart && action == Action::none) return true; // it belongs to the next step
    ++next_;
    order_.note(action);
    if (action != Action::none) onAction_(event, action);
    if (waiting_) return false;
  }
  return true;
}

} // namespace vv
