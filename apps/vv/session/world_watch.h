// world_watch.h: Tells when a world that is shown is to be read again, because one of its files has
// changed (--watch). Owned by those who replace sessions. [main thread]
#pragma once

#include <optional>

#include "options/options.h"
#include "process/messages.h"
#include "start/watched.h"

namespace vv {

class WorldWatch {
 public:
  // The options must outlive this object.
  explicit WorldWatch(const Options& options) : options_(options) {}

  // Watches the files of another world from now on, if that is wanted.
  void follow(const xvrml::World& world) {
    if (options_.watch && world.path != "-") watched_.emplace(usedFiles(world));
  }
  // Returns true once after a change, and says so. now: seconds of any clock.
  bool changed(double now) {
    if (!watched_ || now < nextLook_) return false;
    nextLook_ = now + .2;
    if (!watched_->changed()) return false;
    if (!options_.quiet) say("vv: a file has changed");
    return true;
  }

 private:
  const Options& options_;
  std::optional<Watched> watched_;
  double nextLook_ = 0;
};

} // namespace vv
