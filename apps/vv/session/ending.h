// ending.h: Ends a process that shows a world. [main thread]
#pragma once

namespace vv {

class Session;

// Stops a session; null: there is none. Returns when no thread uses a world any more. Reading a
// world and building geometry cannot be cancelled: if a thread still does after half a second, the
// process ends here with `code`, without cleanup.
void stopOrExit(Session* session, int code);

} // namespace vv
