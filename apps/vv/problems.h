// problems.h: tells what is wrong with a world, each problem once. [main thread]
#pragma once

#include "options.h"

namespace vv {

class Problems {
 public:
  explicit Problems(const Options& options) : options_(options) {}
  // Those that were not told yet.
  void tell(const xvrml::World& world);
  static bool any(const xvrml::World& world) { return world.diagnostics.errors() + world.diagnostics.warnings() > 0; }

 private:
  const Options& options_;
  const xvrml::World* world_ = nullptr; // the one that the numbers are of
  size_t told_ = 0;
  uint64_t droppedTold_ = 0;
};

} // namespace vv
