// browser.h: a running VRML world: time, events, live editing, and the Browser object that Scripts and programs see (ISO/IEC
// 14772-1 4.12.10). It has no clock, no window and no threads: time is an argument, input is handed in, what changed is handed
// out. The same calls with the same arguments give the same world. [one thread: the one that made it]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "xvrml/behaviour.h"
#include "xvrml/camera.h"
#include "xvrml/change.h"
#include "xvrml/world.h"

namespace xvrml {

struct BrowserOptions {
  uint64_t maximumEvents = 1'000'000; // of one cascade
  bool runScripts = true;
  std::string scriptPath; // folders of script engines, separated by colons, before $XVRML_SCRIPT_PATH and the installed one
};

class Browser {
 public:
  // Takes a loaded world over: sensors, Scripts, bindables and routes come alive at time `start` (seconds). The first tick shows
  // the world at that time.
  explicit Browser(std::unique_ptr<World> world, BrowserOptions options = {}, double start = 0);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  World& world();
  Events& events();
  double now() const;
  // Time has come to `time` (seconds, not before now()): sensors send, routes carry, Scripts run, until nothing is left to do.
  void tick(double time);
  // What changed since the last call; for OpenRTMapper::update. Another world (generation()) begins with an empty list.
  FieldChanges takeChanges();
  // Grows by one with every world that takes the place of the former (loadUrl, replaceWorld): make a new mapper.
  uint64_t generation() const;

  // --- Fields and events ---
  // The node that a DEF name of the file means; null if there is none.
  NodeRef node(std::string_view name) const;
  // Sends an event to an exposedField or eventIn (a cascade at now()), or sets a field directly. False if there is no such
  // field or the value is of another type.
  bool set(Node& node, std::string_view field, Value value);
  // The value of a field or exposedField, or the last one an eventOut sent. Throws std::invalid_argument if there is none.
  Value get(const Node& node, std::string_view field) const;
  // Calls back whenever an eventOut or exposedField has sent. Returns a number for unlisten; 0 if there is no such event.
  using Callback = std::function<void(Node& node, const FieldInfo& out, const Value& value)>;
  uint64_t listen(Node& node, std::string_view out, Callback callback);
  void unlisten(Node& node, uint64_t number);

  // --- The viewer ---
  BoundNodes bound() const;
  // Where the viewer is: the bound Viewpoint, and how far navigation has led away from it. aspect: width / height.
  CameraSettings camera(double aspect) const;
  // Seconds of the world's time in which the picture follows when the viewer jumps to another Viewpoint; 0, as at first: at once.
  void setTransition(double seconds);

  // --- Editing ---
  NodeRef createNode(std::string_view type); // with default fields; throws std::invalid_argument for an unknown type
  void addRoot(NodeRef node);
  void removeRoot(Node& node);
  bool addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  bool deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
