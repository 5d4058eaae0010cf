// engine.h: the event engine of ISO/IEC 14772-1 4.10: routes, event cascades, and membership in the
// world. It has one queue, no recursion and no clock: time is an argument. The Browser owns it.
// [the browser's thread]
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <unordered_set>

#include "event/live.h"

namespace xvrml {

// Runs Script nodes. The engine passes their events to it.
class ScriptRunner {
 public:
  virtual ~ScriptRunner() = default;
  virtual void begin(ScriptNode& script) = 0; // the Script has become part of the world
  // Starts the first Script that has begun but is not started. Returns false if there is none.
  virtual bool initializeNext() = 0;
  virtual void receive(ScriptNode& script, const FieldInfo& in, const Value& value) = 0;
  // Calls eventsProcessed() of all Scripts that have received events since the last call. Returns
  // true if there were any.
  virtual bool eventsProcessed() = 0;
  virtual void drop() = 0; // drops the events that still wait
  virtual void tick() = 0; // time has advanced to now()
  // The Script is being destroyed. May be called at any point.
  virtual void end(ScriptNode& script) noexcept = 0;
  virtual void finish() = 0; // Scripts that have ended can be shut down now
};

// Is notified of everything that happens in a running world. The Browser injects the viewer's
// observer.
class EngineObserver {
 public:
  virtual ~EngineObserver() = default;
  virtual void began(const Scope& scope) = 0; // the file's own nodes have become part of the world
  // Called at once for each change that takeChanges would report.
  virtual void changed(Node& node, const FieldInfo& field) = 0;
  virtual void forgotten(const Node& node) = 0; // the node is being destroyed
  virtual void ticked() = 0;  // time has advanced to now(); before the tick() functions
  virtual bool settled() = 0; // no event is left; returns true if it has sent one
};

// Wide because nodes, routes, prototypes and cascades are states of one world that change together:
// an event may end a node, and with it routes, while a cascade is under way.
class Engine final : public Events {
 public:
  // Makes the observer of an engine that is being constructed. The observer may keep the reference,
  // and use it from began() on.
  using MakeObserver = std::function<std::unique_ptr<EngineObserver>(Engine&)>;
  Engine(Diagnostics& diagnostics, const MakeObserver& makeObserver, Browser* browser = nullptr);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  // Returns the engine that a behaviour of the library sees as Events. No other class implements
  // them.
  static Engine& of(Events& events) { return static_cast<Engine&>(events); }

  double now() const override { return now_; }
  using Events::send;
  void send(Node& from, const FieldInfo& out, Value value) override;
  bool hasSent(const Node& from, const FieldInfo& out) const override;
  void preset(Node& from, const FieldInfo& out, Value value) override;
  bool store(Node& node, const FieldInfo& field, Value value) override;
  void post(Node& to, const FieldInfo& in, Value value) override;
  void changed(Node& node, const FieldInfo& field) override;
  Value lastSent(const Node& node, const FieldInfo& out) const override;
  NodeState* state(Node& node) const override;
  void wantTicks(Node& node, bool wanted) override;
  void wantLooks(Node& node, bool wanted) override;
  Diagnostics& diagnostics() override { return diagnostics_; }
  Browser* browser() const override { return browser_; }

  uint64_t maximumEvents = 1'000'000; // limit for one cascade; more are dropped with a message
  ScriptRunner* scripts = nullptr;    // not owned; null: Scripts do nothing
  const std::unique_ptr<EngineObserver> observer;

  // Makes everything in a scope part of the world: nodes, routes, prototype bodies, Inlines. roots:
  // its nodes become roots of the world. Scopes and their contents must outlive the engine or be
  // removed first.
  void adoptScope(const Scope& scope, bool roots);
  void adopt(Node& node);               // adds a node and its descendants
  void contentLoaded(Node& inlineNode); // an Inline that is part of the world has got its content
  // An Inline is about to lose its content: the nodes lose a parent, the routes end.
  void contentUnloading(Node& inlineNode);
  // Make a node a root of the world, or no longer a root (its routes stay).
  void addRoot(Node& node);
  void removeRoot(Node& node);

  // Prepares for another world: only these nodes remain, with their descendants and the targets of
  // their routes. None of them is a root afterwards. Not to be called while events are under way.
  void keepOnly(const std::vector<NodeRef>& kept);
  size_t nodes() const { return lives_.size(); }

  // Adds a route. Returns false, with a message, if there are no such events or their types differ.
  // A route that is added twice exists once.
  bool addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  bool deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  uint64_t routes() const { return routes_; }

  // Begins a cascade. Everything posted or sent until it has settled belongs to it and has its
  // time.
  void beginCascade(double time);
  void settle();
  // Sends one event from outside as a cascade of its own at the present time. Returns false if the
  // node has no such eventIn or the type does not match.
  bool dispatch(Node& to, std::string_view in, Value value);
  // Posts an event of the instance to a node in its body (IS). urlBase: the file that URLs in the
  // value count from.
  void postIntoBody(const ProtoInstance& instance, const FieldInfo& from, const NodeRef& to,
                    const FieldInfo& in, Value value,
                    const std::shared_ptr<const std::string>& urlBase);
  // Advances the time: runs the tick() functions and their cascade, then the look() functions and
  // theirs.
  void tick(double time);
  bool settling() const { return settling_; } // events of others wait in the queue

  uint64_t listen(Node& node, const FieldInfo& out, Listener listener);
  void unlisten(Node& node, uint64_t number);
  void markReach(Node& node, const FieldInfo& in, const std::string& reason);
  FieldChanges takeChanges();
  bool hasChanges() const { return !changes_.empty() || !outdated_.empty() || figuresOutdated_; }
  uint64_t delivered() const { return delivered_; } // number of events so far
  // Grows whenever nodes get or lose a parent, or become or cease to be roots.
  uint64_t structure() const { return structure_; }
  uint64_t cascade() const { return cascade_; }
  // Announces a Script that must be started before the next event.
  void requestScriptStart() { scriptsToStart_ = true; }
  // Figures and particles are moved again when the cascade has settled.
  void outdateFigures() { figuresOutdated_ = true; }
  // Calls all active look() functions within the present cascade.
  void lookNow() { callAll(looking_, &Behaviour::look); }

 private:
  class Settling { // a part of the code that is settling, also if it is left by an exception
   public:
    explicit Settling(Engine& engine) : engine_(engine) { engine_.settling_ = true; }
    ~Settling() { engine_.settling_ = false; }
    Settling(const Settling&) = delete;
    Settling& operator=(const Settling&) = delete;

   private:
    Engine& engine_;
  };
  void deliverAll();
  struct Event {
    NodeRef node;
    const FieldInfo* field;
    Value value;
    bool isArriving; // true: arrives at an eventIn of node; false: is sent by an eventOut of node
    // Arrives at a prototype instance: the file that URLs in the value count from, if it is another
    // than the instance's own.
    std::shared_ptr<const std::string> urlBase = nullptr;
  };
  struct AdoptedNodes; // nodes and scopes that an adoption collects
  Live& makeLive(Node& node);
  Participant& part(Node& node);
  static void forget(LiveBase* base) noexcept;
  void collect(Node& node, AdoptedNodes& adopted);
  void collectScope(const Scope& scope, AdoptedNodes& adopted);
  void complete(AdoptedNodes& adopted);
  void connectBody(ProtoInstance& instance);
  void mirror(Node& node, const FieldInfo& stored);
  void disconnectBody(ProtoInstance& instance);
  void destroyLater(std::unique_ptr<Participant> part) noexcept;
  void linkChild(Node& parent, Node& child);
  void unlinkChild(Node& parent, Node& child);
  void rootsChanged();
  bool wouldCreateCycle(Node& parent, const Value& value);
  void addLink(Node& from, Link link);
  void followLinks(Event& event);
  using FileName = std::shared_ptr<const std::string>;
  void deliver(Node& node, const FieldInfo& in, const Value& value,
               const FileName& urlBase = nullptr);
  void deliverToInstance(ProtoInstance& instance, const FieldInfo& in, const Value& value,
                         FileName urlBase);
  void deliverToScript(ScriptNode& script, const FieldInfo& in, const Value& value);
  bool isHeard(Node& node, const FieldInfo& out);
  void deliverToStatic(Node& node, const FieldInfo& in, const Value& value);
  void sendFromInstance(ProtoInstance& instance, const FieldInfo& out, const Value& value,
                        bool keeps);
  void sweep();
  void renewExpansions();
  void renewExpansion(Node& node);
  void addFigures(const std::vector<NodeRef>& nodes);
  void moveFigures();
  void noteSkin(const Node& figure);
  void reuseNodes(Node& old, Node& fresh);
  using Watchers = std::map<uint32_t, Node*>; // by Live::order
  void callAll(const Watchers& watchers, void (*Behaviour::*function)(Events&, Node&));

  Diagnostics& diagnostics_;
  Browser* const browser_;
  double now_ = 0;
  std::vector<Live*> lives_;
  std::deque<Event> queue_;
  Watchers ticking_, looking_, deforming_;
  std::map<Node*, NodeRef> skins_; // nodes whose vectors these figures move
  FieldChanges changes_;
  std::vector<NodeRef> outdated_; // plug-in nodes whose expansion may have changed
  std::vector<NodeRef> swept_;    // nodes with deleted links
  std::vector<std::unique_ptr<Participant>> pendingDestruction_;
  uint64_t structure_ = 0, cascade_ = 0, delivered_ = 0, inCascade_ = 0, routes_ = 0,
           listeners_ = 0;
  uint32_t order_ = 0;
  bool settling_ = false, overflow_ = false, scriptsToStart_ = false, destroying_ = false,
       figuresOutdated_ = false;
};

} // namespace xvrml
