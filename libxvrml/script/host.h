// host.h: runs the Script nodes of a world (ISO/IEC 14772-1 4.12): finds their engines, delivers
// events to them and takes their outputs. The event engine calls it; scripts call the world through
// the function table in host_table.cpp. The Browser owns it; it is destroyed before the event
// engine. [the browser's thread]
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>

#include "event/engine.h"
#include "script/program.h"
#include "script/remote/processes.h"
#include "script/values.h"
#include "xvrml/browser.h"

namespace xvrml {

// A Script node that has an interpreter, or will get one at its turn.
struct Script {
  using Key = uint32_t; // order of the nodes in the world
  Script(Key key, ScriptNode& node, XsNode self, XsNode& lastNumber)
      : key(key), node(&node), self(self), handles(&node, self, lastNumber) {}

  struct QueuedEvent { // an event that has not been delivered yet
    const FieldInfo* in;
    Value value;
    uint64_t bytes;
  };
  struct Output { // an output of the running function; it is passed on when the function returns
    NodeRef to;   // null: from an eventOut of the Script itself
    const FieldInfo* field;
    Value value;
  };
  // Returns whether the Script declares the field itself. Every node of X3D has `metadata`; in
  // VRML97 it may be a Script's own.
  static bool isOwn(const FieldInfo& field) {
    return field.name != "url" && field.name != "directOutput" && field.name != "mustEvaluate" &&
           !field.isMetadata;
  }
  bool flag(uint32_t bit) const { return info.flags & bit; }
  // Returns whether a call is running in its process, for this Script or another one. Events wait
  // meanwhile.
  bool busy() const { return process && process->busy(); }
  bool ready() const { return engine && !stopped && !busy(); }

  const Key key;
  // Never dangles: the node in the world until it is destroyed (ScriptHost::end), then `nodeCopy`.
  ScriptNode* node;
  const FieldInfo* const url = node->type().find("url"); // the field that names the program
  NodeRef nodeCopy;      // copy of a destroyed node's fields, for shutdown()
  NodeRef heldUntilStop; // the node in the world while all Scripts end
  const XsNode self;
  const XsEngine* engine = nullptr; // null: no runnable program
  XsInterpreter interpreter = 0;
  SourcePosition start; // position of the program text
  std::string scheme, origin, text;
  XsScriptInfo info{};
  std::vector<XsField> fields;

  // For an interpreter in another process (script/remote):
  ProcessRef process;  // null: the interpreter is in this process
  uint32_t number = 0; // the interpreter's number in that process
  wire::Op pending{};  // the function running there; 0: none
  // A `create` was sent before the Script's turn to start; nothing serves it yet.
  bool startedEarly = false;
  bool startPending = false; // it will be started (again); events wait
  int restarts = 0;
  // A program that was late is not waited for in its next `unwaited` calls: twice as many as the
  // time before (`lastUnwaited`), until its function `late` returns in time again.
  wire::Op late{};
  uint32_t unwaited = 0, lastUnwaited = 0;
  // eventsProcessed must be called when the current call has returned.
  bool eventsProcessedDue = false;
  size_t nextUrl = 0;
  uint64_t waitingBytes = 0, dropped = 0;

  bool wasStopped = false; // value of `stopped` when the running function was called
  bool stopped = false;    // out of time: no more calls except shutdown and destroy
  bool failed = false;     // the running function has logged an error
  uint64_t steps = 0;      // used by the running function
  // When the running function was called, and the processor time of the thread then, in seconds.
  std::chrono::steady_clock::time_point since;
  double processor = 0;

  Handles handles;
  LentValue lent; // the last value given out through XsHost
  std::string lentText, error;
  std::deque<QueuedEvent> waiting;
  std::vector<Output> outputs;
  // Printed texts and warnings that were logged, each once.
  std::unordered_set<std::string> reported;
  // Logged errors, each once. They are separate, so that printed texts cannot hide them.
  std::unordered_set<std::string> failures;
  bool counted = false; // counted in ScriptCounts::started, which ignores restarts
};

// Owns every Script from begin() on. A Script is freed in two places only: in finish(), after its
// node has been destroyed, and at the end of the destructor. Handles of Scripts may hold the last
// reference to any node, also to a Script's. So dropping handles may end other Scripts, or the
// Script itself; end() then moves them to `ended_`, where they stay usable until finish().
// Wide because Scripts, their handles and their time have one owner.
class ScriptHost : public ScriptRunner {
 public:
  struct Table; // the XsHost of the scripts, with a reference to this host
  ScriptHost(Browser& browser, Engine& engine, World& world, const BrowserOptions& options,
             const RunOptions& run);
  ~ScriptHost() override; // shuts down all Scripts
  ScriptHost(const ScriptHost&) = delete;
  ScriptHost& operator=(const ScriptHost&) = delete;

  void begin(ScriptNode& script) override;
  bool initializeNext() override;
  void receive(ScriptNode& script, const FieldInfo& in, const Value& value) override;
  bool eventsProcessed() override;
  void drop() override;
  void tick() override;
  void end(ScriptNode& script) noexcept override;
  void finish() override;

  size_t running() const { return scripts_.size(); }
  ScriptCounts counts() const;
  // Returns the node whose function is running; null if there is none.
  const Node* runningNode() const { return running_ ? running_->node : nullptr; }

 private:
  friend struct HostCalls;
  friend struct HostTable;
  friend struct HostScene;
  using Key = Script::Key;

  // Results of calls in addition to XsResult.

  // The function is still running in its process; tick() serves it.
  static constexpr auto later = XsResult(0x7ffffff0);
  // Its process was already dead; the Script is restarted.
  static constexpr auto again = XsResult(0x7ffffff1);

  // Starting Scripts: host_start.cpp.
  void startEarly();
  bool sendCreateEarly(Script& script);
  const XsHost* table() const;
  void start(Script& script);
  void describe(Script& script, ScriptProgram program);
  XsResult makeInterpreter(Script& script, ScriptProgram program);
  void dropInterpreter(Script& script);
  bool created(Script& script, XsResult result);
  void stop(Script& script); // calls shutdown and destroy
  void shutDownEarly(Key from);
  void enter(Script& script);
  XsResult leave(Script& script, const char* function, XsResult result);
  template <class Invoke> XsResult call(Script& script, const char* function, Invoke&& invoke) {
    const NodeRef keep(script.node);
    enter(script);
    const XsResult result = runAs(&script, invoke);
    return leave(script, function, result);
  }
  // Calls `serve` while the functions of XsHost answer `script` only; null: nobody.
  template <class Serve> auto runAs(Script* script, Serve&& serve) {
    struct Restore {
      Script*& running;
      Script* outer;
      ~Restore() { running = outer; }
    } const restore{running_, std::exchange(running_, script)};
    return serve();
  }
  using Function = XsResult (*XsEngine::*)(XsInterpreter, double);
  XsResult plainCall(Script& script, wire::Op op, Function function);
  void drain(Key key, Script& script);
  void queue(Script& script, const FieldInfo& in, const Value& value);

  // Scripts in processes of their own: host_remote.cpp.
  bool isolated(const XsEngine& engine) const;
  ProcessRef chooseProcess(const XsEngine& engine, size_t coming, std::string& why);
  XsResult beginCreate(Script& script, const ProcessRef& process);
  XsResult createRemote(Script& script);
  XsResult beginCall(Script& script, wire::Op op, wire::Writer& message);
  XsResult callRemote(Script& script, wire::Op op, wire::Writer& message);
  XsResult serveCall(Script& script, double first, double next, wire::Clock::time_point until);
  XsResult waitFor(Script& script);
  wire::Clock::time_point patienceEnds() const;
  wire::Clock::time_point waitEnds(const Script& script) const;
  static void noteLateness(Script& script, wire::Op op, bool late);
  void handleLostProcess(Script& script, wire::Op op, bool tooLong);
  void detach(Script& script);
  void restartAll(const ScriptProcess& gone);
  void restart(Key key, Script& script, const std::string& why);
  void stopRemote(Script& script);
  void discard(const ProcessRef& process, double first, wire::Clock::time_point until);
  void serveRunningCalls();

  void flush(Script& script);
  void deliver(Script& script, const FieldInfo& in, const Value& value);
  Script* find(XsNode self);
  void log(Script& script, int severity, uint32_t line, const std::string& text);
  bool isLate(const Script& script) const;
  bool overBudget(Script& script, uint64_t steps);
  void chargeTime(std::chrono::steady_clock::duration time, double processor);
  void chargeProcesses();
  bool isTimeUsedUp() const {
    return options_.scriptPatience <= 0 &&
           (used_ >= run_.worldScriptSeconds || waited_ >= maxWaiting * run_.worldScriptSeconds);
  }
  void stopAll();
  void markReach(Script& script);

  Browser& browser_;
  Engine& engine_;
  World& world_;
  const BrowserOptions& options_;
  const RunOptions& run_;
  ProgramFinder programs_;
  std::unique_ptr<Table> table_;
  std::map<Key, std::unique_ptr<Script>> scripts_;
  std::unordered_map<XsNode, Script*> bySelf_;
  std::deque<Key> startQueue_; // start queue, in order
  size_t earlyHandled_ = 0;    // how many of the queue startEarly() has handled
  size_t earlyStarts_ = 0;     // Scripts whose `create` was sent before their turn
  // Scripts whose nodes have been destroyed, in that order. There is always room for all Scripts,
  // so that end() needs no memory.
  std::vector<std::unique_ptr<Script>> ended_;
  const NodeRef nobody_;    // stands for a destroyed node that cannot be copied
  std::map<Key, bool> due_; // eventsProcessed is due; true: events are waiting
  std::vector<Key> ticking_;
  std::vector<Key> waitingForProcess_;         // to be started when their processes are idle
  std::unique_ptr<ScriptProcesses> processes_; // null until one is needed
  std::unordered_set<std::string> unusable_;   // engines reported to have no process
  wire::Writer message_;
  uint32_t interpreters_ = 0; // number of interpreters ever made in processes
  // Seconds that calls may still wait before the next tick. Below 0 calls hardly wait.
  double patience_;
  // Limits of RunOptions::worldScriptSeconds. They count processor time, so that a busy machine
  // stops no Script that would run on an idle one. A sleeping Script uses none, so waiting is
  // limited too.
  static constexpr double maxWaiting = 10;
  double used_ = 0, waited_ = 0;   // in seconds: processor time, wall clock time
  std::optional<double> lastTick_; // the world's time at the last tick
  bool limitReported_ = false;
  ScriptCounts counts_;
  wire::Clock::time_point shutdownDeadline_ = wire::never;
  XsNode lastNumber_ = 0;
  Script* running_ = nullptr;
  bool ending_ = false;  // outputs are discarded
  bool closing_ = false; // the world is being destroyed
};

} // namespace xvrml
