// signals.h: Handles signals; main() installs the handlers, which only set flags.
//
// * SIGINT, SIGTERM, SIGXCPU and, unless nohup ignores it, SIGHUP end a picture early and keep the
//   finished part. A second one ends the process at once. So does a time limit, because a shader
//   may hang.
// * SIGUSR1 requests a copy of the picture so far.
// * A crash prints the shader that was running.
#pragma once

namespace vv {

void installSignals();

// While `on`, the first SIGINT is only recorded for interrupted(); otherwise it ends the process at
// once with exit code 130. If `seconds` is above 0, the process ends that long after the first
// SIGINT, unless interruptHandled() was called.
void deferInterrupt(bool on, unsigned seconds = 0);
bool interrupted();
int secondsInterrupted(); // whole seconds since the interrupt; 0: there was none
void interruptHandled();  // the render has stopped; the rest of the work has no time limit
void limitInterrupt();    // after an interrupt, the rest of the work has the time limit again

// Returns true once for each SIGUSR1.
bool takeSaveRequest();

} // namespace vv
