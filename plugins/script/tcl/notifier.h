// notifier.h: how Tcl waits for files and windows here. [the browser's thread]
#pragma once

namespace tclscript {

// Instead of Tcl's own, which has a thread: the host program forks, blocks signals and limits
// threads as it likes. Before Tcl is used for the first time in the process.
void setNotifier();

} // namespace tclscript
