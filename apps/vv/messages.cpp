// messages.cpp: see messages.h.
#include "messages.h"

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "picture/atomic_file.h"
#include "printable.h"

namespace vv {

void say(const std::string& text) {
  const std::string line = printable(text) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void sayError(const std::string& text) { say("vv: error: " + text); }
void sayWarning(const std::string& text) { say("vv: warning: " + text); }

void sayDiagnostics(const xvrml::Diagnostics& diagnostics, size_t limit, bool quiet) {
  size_t said = 0, left = 0;
  for (const xvrml::Diagnostic& diagnostic : diagnostics.list()) {
    if (quiet && diagnostic.severity != xvrml::Severity::error) continue;
    if (limit && said == limit) {
      ++left;
      continue;
    }
    say(diagnostic.text());
    ++said;
  }
  left += diagnostics.dropped();
  if (left)
    say(fmt::format("vv: and {} more (errors: {}, warnings: {} in all)", left, diagnostics.errors(), diagnostics.warnings()));
}

void writeData(const std::string& bytes) {
  try {
    picture::writeDescriptor(STDOUT_FILENO, ::isatty(STDOUT_FILENO) ? printable(bytes) : bytes, "standard output");
  } catch (const std::runtime_error&) {
    if (errno != EPIPE) throw;
  }
}

void writeOut(const std::string& text) { writeData(printable(text)); }

} // namespace vv
