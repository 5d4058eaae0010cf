// messages.h: what vv says on standard error. [main thread; other threads do not talk]
#pragma once

#include <string>

#include "options.h"
#include "xvrml/diagnostics.h"

namespace vv {

// "vv: error: ..." and "vv: warning: ..." as one line each.
void sayError(const std::string& text);
void sayWarning(const std::string& text);
void say(const std::string& text);

// Diagnostics with place, source line and caret; at most `limit` (0: all), then how many more there are. quiet: errors only.
void sayDiagnostics(const xvrml::Diagnostics& diagnostics, size_t limit, bool quiet);

// Writes data to standard output. A reader that has gone away is no error.  Throws std::runtime_error otherwise.
void writeOut(const std::string& text);

} // namespace vv
