// state.h: what a Browser is made of. One member a subsystem, each with files of its own.
#pragma once

#include "event/engine.h"
#include "script/host.h"
#include "xvrml/browser.h"

namespace xvrml {

struct Browser::Impl {
  Impl(Browser& browser, std::unique_ptr<World> world, const BrowserOptions& options,
       const RunOptions& run);
  void settle() { // what has been made outside of a cascade
    if (engine->settling()) return;
    engine->beginCascade(engine->now());
    engine->settle();
  }
  // Does what had to wait for the end of a cascade. Much of it waits for the next call: a world may
  // load itself for ever.
  void workOff();
  void later(std::function<void()> job);
  SourcePosition asking() const; // the Script that calls, else the world's file
  MFNode adopt(World& loaded);   // what has been loaded beside the world
  void become(Scope scope, const std::vector<NodeRef>& kept,
              std::vector<NodeRef> cyclic); // another world

  BrowserOptions options;
  RunOptions run;
  std::unique_ptr<World> world;
  std::unique_ptr<Engine> engine;      // ends before the world
  std::unique_ptr<ScriptHost> scripts; // ends before the engine; null: Scripts do nothing
  double time = 0;                     // after run.epoch; the engine's time is their sum, rounded
  uint64_t generation = 1;
  std::function<void(Node& anchor)> onAnchor;
  std::deque<std::function<void()>> jobs;
  bool working = false;
  std::string description;
  double frameRate = 0;
};

} // namespace xvrml
