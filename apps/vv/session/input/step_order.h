// step_order.h: Keeps the order in which the events of a step happen, so that a script, the session
// that records it and every replay of it agree. A save ends its step: its picture shows the world
// after the events before it, and the events behind it that reach the world belong to the next
// step. docs/window.md describes the rule. Owned by a Session or a Replay. [the browser's thread]
#pragma once

#include "session/input/keys.h"

namespace vv {

class StepOrder {
 public:
  // Begins a step, after which events of any kind may happen again.
  void begin() { isEnded_ = false; }
  // Notes the action of an event that has happened in this step.
  void note(Action action) { isEnded_ |= action == Action::save || action == Action::saveExr; }
  // Tells whether a save has ended the step. Only events for the window alone belong to it then.
  bool isEnded() const { return isEnded_; }

 private:
  bool isEnded_ = false;
};

} // namespace vv
