// state.h: the state of a Browser: one member per subsystem, each with files of its own.
#pragma once

#include "event/engine.h"
#include "script/host.h"
#include "xvrml/browser.h"

namespace xvrml {

struct Browser::Impl {
  Impl(Browser& browser, std::unique_ptr<World> world, const BrowserOptions& options,
       const RunOptions& run);
  void settle() { // runs a cascade for changes made outside of one
    if (engine->settling()) return;
    engine->beginCascade(engine->now());
    engine->settle();
  }
  // Runs jobs that had to wait for the end of a cascade. Many are left to the next call, because a
  // world may load itself for ever.
  void runJobs();
  void addJob(std::function<void()> job);
  SourcePosition callerPosition() const; // the calling Script, else the world's file
  // Returns how many files and Scripts are around what the calling Script makes: it grows along a
  // chain of Scripts that make one another, by text or by prototypes.
  uint64_t depthOfMade() const;
  // Makes nodes of a text, which may use the prototypes.
  MFNode create(std::string_view text, const std::string& base,
                std::span<const ProtoPtr> prototypes);
  MFNode adopt(World& loaded); // takes over what was loaded besides the world
  void replaceScene(Scope scope, const std::vector<NodeRef>& kept,
                    std::vector<NodeRef> cyclic); // replaces the world

  BrowserOptions options;
  RunOptions run;
  std::unique_ptr<World> world;
  std::unique_ptr<Engine> engine;      // destroyed before the world
  std::unique_ptr<ScriptHost> scripts; // destroyed before the engine; null: Scripts do not run
  double time = 0; // time since run.epoch; the engine's time is their rounded sum
  uint64_t generation = 1;
  std::function<void(Node& anchor)> onAnchor;
  std::deque<std::function<void()>> jobs;
  bool working = false;
  std::string description;
  double frameRate = 0;
};

} // namespace xvrml
