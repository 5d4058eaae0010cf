// problems.h: tells what is wrong with a world, each problem once, and each sentence once, however
// often the world gives a reason for it. [main thread]
#pragma once

#include <string>
#include <unordered_set>

#include "options/options.h"

namespace vv {

class Problems {
 public:
  explicit Problems(const Options& options) : options_(options) {}
  // Those that were not told yet. Messages that differ only in their places and numbers are told
  // once, with how many more there are; -v and --check tell all of them, and also the details that
  // nobody sees.
  void tell(const xvrml::World& world);
  // Says at the end of a run that succeeds how many messages were like those told before; and, as
  // its last line, if there were errors, what is left out, and what would refuse it.
  void tellEnd(const xvrml::World& world) const;
  static bool any(const xvrml::World& world) {
    return world.diagnostics.errors() + world.diagnostics.warnings() > 0;
  }

 private:
  void tellFolded(const std::vector<xvrml::Diagnostic>& fresh);
  const Options& options_;
  const xvrml::World* world_ = nullptr; // the one that the numbers are of
  size_t told_ = 0;
  uint64_t droppedTold_ = 0;
  uint64_t repeated_ = 0;                 // messages of kinds that had been told before
  std::unordered_set<std::string> kinds_; // of sentences that have been told
};

// Returns what messages have in common that say the same of different places: severity and text,
// numbers as #.
std::string kindOf(const xvrml::Diagnostic& diagnostic);

} // namespace vv
