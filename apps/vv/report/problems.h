// problems.h: Reports the problems of a world. Each problem, and each message text, is reported
// once, however often the world causes it. [main thread]
#pragma once

#include <string>
#include <unordered_set>

#include "options/options.h"

namespace vv {

class Problems {
 public:
  explicit Problems(const Options& options) : options_(options) {}
  // Reports the problems that have not been reported yet. Messages that differ only in position and
  // numbers are reported once, with the number of the others. -v and --check report all of them,
  // and also the notes.
  void tell(const xvrml::World& world);
  // Reports, at the end of a successful run, how many messages repeated earlier ones. If there were
  // errors, the last line says how many and where, and which option would reject the world.
  void reportEnd(const xvrml::World& world) const;
  static bool any(const xvrml::World& world) {
    return world.diagnostics.errors() + world.diagnostics.warnings() > 0;
  }

 private:
  void reportGrouped(const std::vector<xvrml::Diagnostic>& fresh);
  const Options& options_;
  const xvrml::World* world_ = nullptr; // the world that the counts below refer to
  size_t reported_ = 0;
  uint64_t droppedTold_ = 0;
  uint64_t repeated_ = 0;                 // messages of a kind that had been reported before
  std::unordered_set<std::string> kinds_; // kinds that have been reported
};

// Returns the common part of messages that say the same about different places: severity and text,
// with numbers replaced by #.
std::string kindOf(const xvrml::Diagnostic& diagnostic);

} // namespace vv
