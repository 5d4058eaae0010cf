// signals.h: SIGINT and SIGTERM end a picture early and keep what there is, a second one ends at
// once, and so does a while without an end, because a shader may hang; SIGUSR1 asks for a copy of
// the picture so far. A crash says which shader was running. Installed by main(); the handlers only
// set flags.
#pragma once

namespace vv {

void installSignals();

// While `on`, the first SIGINT is noted for interrupted(); otherwise it ends the process with exit
// code 130 at once. seconds: above 0, the process ends anyhow when so much time has passed since
// then, unless interruptObeyed() was called.
void deferInterrupt(bool on, unsigned seconds = 0);
bool interrupted();
int secondsInterrupted(); // whole seconds since then; 0: it was not
void interruptObeyed();   // what was to stop has stopped; what is left takes as long as it takes

// True once for each SIGUSR1.
bool takeSaveRequest();

} // namespace vv
