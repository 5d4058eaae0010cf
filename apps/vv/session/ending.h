// ending.h: Ends a session, and a process that shows a world. [main thread]
#pragma once

#include <cstdint>

namespace vv {

class Session;

// Whether threads that know nothing of worlds, such as those that write files, still work.
enum class Others : uint8_t { rest, work };

// Keeps the edits of a session that are not saved, and says where they are, or that they are lost.
// To be called before a session ends for any reason, unless its user has thrown them away. null:
// there is no session.
void keepEdits(Session* session);

// Stops a session; null: there is none. Returns when no thread uses a world any more. Reading a
// world, building geometry and writing a file cannot be cancelled: if a thread still does so after
// half a second, the process ends here with `code`, without cleanup.
void stopOrExit(Session* session, int code, Others others = Others::rest);

} // namespace vv
