// engine.h: the event engine of ISO/IEC 14772-1 4.10: routes, cascades, who is part of the world.
// One queue, no recursion, no clock of its own: time is an argument. Owned by the Browser; on its
// thread.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <unordered_set>

#include "event/live.h"

namespace xvrml {

// Runs Script nodes; the engine hands their events over.
class ScriptRunner {
 public:
  virtual ~ScriptRunner() = default;
  virtual void begin(ScriptNode& script) = 0; // part of the world now
  virtual bool
  initializeNext() = 0; // starts the first of those that have begun; false if there is none
  virtual void receive(ScriptNode& script, const FieldInfo& in, const Value& value) = 0;
  // Calls eventsProcessed() of all Scripts that received something since; true if there was one.
  virtual bool eventsProcessed() = 0;
  virtual void drop() = 0; // events that still wait are dropped
  virtual void tick() = 0; // time has come to now()
  virtual void
  end(ScriptNode& script) noexcept = 0; // is being destroyed; called wherever that happens
  virtual void finish() = 0;            // a good time to shut down those that have ended
};

// Is told what happens in a running world while it happens. The Browser injects the one of the
// viewer.
class EngineObserver {
 public:
  virtual ~EngineObserver() = default;
  virtual void began(const Scope& scope) = 0; // the file's own nodes are part of the world now
  virtual void
  changed(Node& node,
          const FieldInfo& field) = 0;          // every change that takeChanges would tell, at once
  virtual void forgotten(const Node& node) = 0; // is being destroyed
  virtual void ticked() = 0;                    // time has come to now(); before tick() functions
  virtual bool settled() = 0; // nothing is left to do: true if it has sent something
};

class Engine : public Events {
 public:
  // Makes the observer of an engine that is being constructed. It may keep the reference, and call
  // it from began() on.
  using MakeObserver = std::function<std::unique_ptr<EngineObserver>(Engine&)>;
  Engine(Diagnostics& diagnostics, const MakeObserver& makeObserver, Browser* browser = nullptr);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  uint64_t maximumEvents = 1'000'000; // of one cascade; more are dropped with a message
  ScriptRunner* scripts = nullptr;    // not owned; null: Scripts do nothing
  const std::unique_ptr<EngineObserver> observer;

  // Makes everything in a scope part of the world: nodes, routes, bodies of prototypes, Inlines.
  // roots: its nodes are roots of the world. Scopes and what they hold must outlive the engine or
  // be taken out.
  void adoptScope(const Scope& scope, bool roots);
  void adopt(Node& node);               // a node and all below
  void contentLoaded(Node& inlineNode); // an Inline that is part of the world has got its content
  void
  contentLeaves(Node& inlineNode); // is about to lose it: its nodes lose a parent, its routes end
  // Makes a node a root of the world, or no longer one (its routes stay).
  void addRoot(Node& node);
  void removeRoot(Node& node);

  // Another world is to come: of all nodes only these remain, with what hangs below them and what
  // their routes lead to; none is a root any more. Not while events are under way.
  void keepOnly(const std::vector<NodeRef>& kept);
  size_t nodes() const { return lives_.size(); }

  // False, with a message, if there are no such events or their types differ; adding a route twice
  // is adding it once.
  bool addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  bool deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  uint64_t routes() const { return routes_; }

  // Everything posted or sent from here on has one time and belongs to one cascade, until it has
  // settled.
  void beginCascade(double time);
  void settle();
  // One event from outside as a cascade of its own at the present time. False if the node has no
  // such eventIn or the type does not match.
  bool dispatch(Node& to, std::string_view in, Value value);
  // Time has come: tick() functions and their cascade, then look() functions and theirs.
  void tick(double time);
  bool settling() const { return settling_; }

  uint64_t listen(Node& node, const FieldInfo& out, Listener listener);
  void unlisten(Node& node, uint64_t number);
  void markReach(Node& node, const FieldInfo& in, const std::string& reason);
  FieldChanges takeChanges();
  bool hasChanges() const { return !changes_.empty() || !outdated_.empty(); }
  uint64_t delivered() const { return delivered_; } // events so far
  uint64_t structure() const {
    return structure_;
  } // grows whenever nodes get or lose a parent or become roots or no longer
  uint64_t cascade() const { return cascade_; }
  // Some Script is to be started before the next event.
  void scriptsBegin() { scriptsBegin_ = true; }
  // Calls look() of all that want it, within the present cascade.
  void lookNow() { callAll(looking_, &Behaviour::look); }

 private:
  friend class Events;
  struct Event {
    NodeRef node;
    const FieldInfo* field;
    Value value;
    bool arriving; // at an eventIn of node; else it leaves an eventOut
  };
  struct Newcomers; // what an adoption has met
  Live& makeLive(Node& node);
  Participant& part(Node& node);
  static void forget(LiveBase* base) noexcept;
  void enter(Node& node, Newcomers& newcomers);
  void enterScope(const Scope& scope, Newcomers& newcomers);
  void complete(Newcomers& newcomers);
  void connectBody(ProtoInstance& instance);
  void mirror(Node& node, const FieldInfo& stored);
  void disconnectBody(ProtoInstance& instance);
  void bury(std::unique_ptr<Participant> part) noexcept;
  void linkChild(Node& parent, Node& child);
  void unlinkChild(Node& parent, Node& child);
  void rootsChanged();
  bool wouldLoop(Node& parent, const Value& value);
  void addLink(Node& from, Link link);
  void leave(Event& event);
  void arrive(Node& node, const FieldInfo& in, const Value& value);
  void arriveAtInstance(ProtoInstance& instance, const FieldInfo& in, const Value& value);
  void arriveAtStatic(Node& node, const FieldInfo& in, const Value& value);
  void relay(ProtoInstance& instance, const FieldInfo& out, const Value& value, bool keeps);
  void sweep();
  void renewExpansions();
  void renewExpansion(Node& node);
  void takeOver(Node& old, Node& fresh);
  using Watchers = std::map<uint32_t, Node*>; // by order
  void callAll(const Watchers& watchers, void (*Behaviour::*function)(Events&, Node&));

  std::vector<Live*> lives_;
  std::deque<Event> queue_;
  Watchers ticking_, looking_;
  FieldChanges changes_;
  std::vector<NodeRef> outdated_; // nodes of plug-ins that may stand for something else now
  std::vector<NodeRef> swept_;    // nodes with deleted links
  std::vector<std::unique_ptr<Participant>> buried_;
  uint64_t structure_ = 0, cascade_ = 0, delivered_ = 0, inCascade_ = 0, routes_ = 0,
           listeners_ = 0;
  uint32_t order_ = 0;
  bool settling_ = false, overflow_ = false, scriptsBegin_ = false, burying_ = false;
};

} // namespace xvrml
