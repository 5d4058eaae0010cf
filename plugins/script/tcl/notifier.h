// notifier.h: Implements how Tcl waits for files and windows. [the browser's thread]
#pragma once

namespace tclscript {

// Replaces Tcl's own notifier, which has a thread: the host program may fork, block signals and
// limit threads. Call it before the first use of Tcl in the process.
void setNotifier();

} // namespace tclscript
