// diagnostics.h: messages with a position: "file:line:column: severity: what is wrong, what was
// expected".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "xvrml/node.h"

namespace xvrml {

enum class Severity : uint8_t { note, warning, error };

struct Diagnostic {
  Severity severity = Severity::error;
  std::string file;
  uint32_t line = 0, column = 0; // counted in characters from 1; 0: the whole file
  std::string message;
  // The line that the message is about, cut to a readable length; "" if unknown.
  std::string sourceLine;
  // The position as a column of sourceLine, if that is a part of a long line; 0: the same as
  // column.
  uint32_t caret = 0;
  // Returns "file:line:column: error: message", then the source line and a caret.
  std::string text() const;
};

// Collects messages in order. At most `limit` are kept; the others are counted.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic);
  void warn(const SourcePosition& where, std::string message);
  void error(const SourcePosition& where, std::string message);
  // Returns whether one more message of this severity would be kept; otherwise it is only counted.
  bool keeps(Severity severity) const {
    const uint64_t errors = errors_ < limit ? errors_ : limit;
    return (severity == Severity::error ? errors : list_.size() - errors) < limit;
  }
  const std::vector<Diagnostic>& list() const { return list_; }
  uint64_t errors() const { return errors_; }
  uint64_t warnings() const { return warnings_; }
  uint64_t dropped() const { return dropped_; }
  size_t limit = 1000; // limit for errors, and also for all other messages

 private:
  std::vector<Diagnostic> list_;
  uint64_t errors_ = 0, warnings_ = 0, dropped_ = 0;
};

} // namespace xvrml
