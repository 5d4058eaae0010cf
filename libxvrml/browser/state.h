// state.h: what a Browser is made of. One member a subsystem, each with files of its own.
#pragma once

#include "event/engine.h"
#include "xvrml/browser.h"

namespace xvrml {

struct Browser::Impl {
  Impl(Browser& browser, std::unique_ptr<World> world, const BrowserOptions& options)
      : options(options), world(std::move(world)), engine(std::make_unique<Engine>(this->world->diagnostics, &browser)) {
    engine->maximumEvents = options.maximumEvents;
  }

  BrowserOptions options;
  std::unique_ptr<World> world;
  std::unique_ptr<Engine> engine; // ends before the world
  uint64_t generation = 1;
  std::function<void(Node& anchor)> onAnchor;
};

} // namespace xvrml
