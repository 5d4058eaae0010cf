// messages.h: Prints vv's messages to standard error. [main thread only]
#pragma once

#include <string>

namespace vv {

// Prints "vv: error: ..." or "vv: warning: ..." as one line.
void sayError(const std::string& text);
void sayWarning(const std::string& text);
void say(const std::string& text);

// Writes text for people to standard output. Control characters in a world's strings are made
// visible. A closed pipe is not an error. Throws std::runtime_error for other errors.
void writeOut(const std::string& text);
// Writes a file to standard output, byte for byte unless that is a terminal. Errors as for
// writeOut().
void writeData(const std::string& bytes);

} // namespace vv
