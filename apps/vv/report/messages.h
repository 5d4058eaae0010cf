// messages.h: what vv says on standard error. [main thread; other threads do not talk]
#pragma once

#include <string>

#include "options/options.h"

namespace vv {

// "vv: error: ..." and "vv: warning: ..." as one line each.
void sayError(const std::string& text);
void sayWarning(const std::string& text);
void say(const std::string& text);

// Writes text for people to standard output: control characters of a world's strings are shown, not
// obeyed. A reader that has gone away is no error. Throws std::runtime_error otherwise.
void writeOut(const std::string& text);
// Writes a file to standard output, byte for byte unless that is a terminal. Errors as above.
void writeData(const std::string& bytes);

} // namespace vv
