#include "messages.h"

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "printable.h"

namespace vv {

void say(const std::string& text) {
  const std::string line = printable(text) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void sayError(const std::string& text) { say("vv: error: " + text); }
void sayWarning(const std::string& text) { say("vv: warning: " + text); }

void writeData(const std::string& bytes) {
  try {
    picture::writeDescriptor(STDOUT_FILENO, ::isatty(STDOUT_FILENO) ? printable(bytes) : bytes,
                             "standard output");
  } catch (const std::runtime_error&) {
    if (errno != EPIPE) throw;
  }
}

void writeOut(const std::string& text) { writeData(printable(text)); }

} // namespace vv
