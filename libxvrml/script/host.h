// host.h: runs the Script nodes of a world (ISO/IEC 14772-1 4.12): finds their engines, brings them
// events, takes theirs. The engine of events calls it; scripts call the world through the table of
// functions in host_table.cpp. Owned by the Browser, ends before the engine of events. [the
// browser's thread]
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

// A Script node that has an interpreter, or will have one at its turn.
struct Script {
  Script(ScriptNode& node, XsNode self, XsNode& lastNumber)
      : node(&node), self(self), handles(&node, self, lastNumber) {}

  struct Waiting { // an event that has not been brought yet
    const FieldInfo* in;
    Value value;
    uint64_t bytes;
  };
  struct Output { // what the running function has sent, for when it returns
    NodeRef to;   // null: from an eventOut of the Script itself
    const FieldInfo* field;
    Value value;
  };
  static bool isOwn(const FieldInfo& field) {
    return field.name != "url" && field.name != "directOutput" && field.name != "mustEvaluate";
  }
  bool flag(uint32_t bit) const { return info.flags & bit; }
  // A call is under way in its process, its own or another one's: events wait.
  bool busy() const { return process && process->busy(); }
  bool ready() const { return engine && !stopped && !busy(); }

  ScriptNode* node; // part of the world; after it has been destroyed `ghost`
  NodeRef ghost;    // keeps the fields of a node that is no more, for shutdown()
  const XsNode self;
  const XsEngine* engine = nullptr; // null: no program that could be run
  XsInterpreter interpreter = 0;
  SourcePosition start; // of the program
  std::string scheme, origin, text;
  XsScriptInfo info{};
  std::vector<XsField> fields;

  // Its interpreter in another process (script/remote)
  ProcessRef process;  // null: it is in this one
  uint32_t number = 0; // of the interpreter there
  wire::Op pending{};  // the function that is running there; 0: none
  bool ahead = false; // that is `create`, and the Script's turn to start has not come: nobody looks
                      // after it yet
  bool expected = false; // will be started, again or for the first time: events wait
  int restarts = 0;
  bool owed = false; // eventsProcessed, when the call under way has returned
  size_t nextUrl = 0;
  uint64_t waitingBytes = 0, dropped = 0;

  bool wasStopped = false; // when the running function was called
  bool stopped = false;    // used up its time: no more calls but shutdown and destroy
  bool failed = false;     // the running function has logged an error
  uint64_t steps = 0;      // of the running function
  std::chrono::steady_clock::time_point since;

  Handles handles;
  LentValue lent; // what XsHost gave out last
  std::string lentText, error;
  std::deque<Waiting> waiting;
  std::vector<Output> outputs;
  std::unordered_set<std::string> told; // what it has printed, and warnings, each of them once
  std::unordered_set<std::string>
      failures;         // errors, each once: what a Script prints cannot hide them
  bool counted = false; // in ScriptCounts::started, which restarts leave as it is
};

class ScriptHost : public ScriptRunner {
 public:
  struct Table; // the XsHost that scripts get, with the way back to this
  ScriptHost(Browser& browser, Engine& engine, World& world, const BrowserOptions& options,
             const RunOptions& run);
  ~ScriptHost() override; // shuts all down
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
  // Returns the node whose function is running; null if none is.
  const Node* runningNode() const { return running_ ? running_->node : nullptr; }

 private:
  friend struct HostTable;
  using Key = uint32_t; // order of the nodes in the world

  // Answers of calls beside those of XsResult
  static constexpr auto later =
      XsResult(0x7ffffff0); // the function is still running in its process; see tick
  static constexpr auto again =
      XsResult(0x7ffffff1); // its process was gone before: it is started anew

  // Starting Scripts: host_start.cpp
  void startAhead();
  bool sendAhead(Script& script);
  const XsHost* table() const;
  void start(Script& script);
  void describe(Script& script, ScriptProgram program);
  XsResult makeInterpreter(Script& script, ScriptProgram program);
  void giveUp(Script& script);
  bool created(Script& script, XsResult result);
  void stop(Script& script); // shutdown and destroy
  void shutDownAhead(Key from);
  void enter(Script& script);
  XsResult leave(Script& script, const char* function, XsResult result);
  template <class Invoke> XsResult call(Script& script, const char* function, Invoke&& invoke) {
    const NodeRef keep(script.node);
    enter(script);
    Script* const outer = std::exchange(running_, &script);
    const XsResult result = invoke();
    running_ = outer;
    return leave(script, function, result);
  }
  using Function = XsResult (*XsEngine::*)(XsInterpreter, double);
  XsResult plainCall(Script& script, wire::Op op, Function function);
  void drain(Key key, Script& script);
  void queue(Script& script, const FieldInfo& in, const Value& value);

  // Scripts in processes of their own: host_remote.cpp
  bool isolated(const XsEngine& engine) const;
  ProcessRef chooseProcess(const XsEngine& engine, size_t coming, std::string& why);
  XsResult beginCreate(Script& script, const ProcessRef& process);
  XsResult createRemote(Script& script);
  XsResult beginCall(Script& script, wire::Op op, wire::Writer& message);
  XsResult callRemote(Script& script, wire::Op op, wire::Writer& message);
  XsResult serveCall(Script& script, double first, double next, wire::Clock::time_point until);
  XsResult waitFor(Script& script);
  wire::Clock::time_point patienceEnds() const;
  void lose(Script& script, wire::Op op, bool tooLong);
  void detach(Script& script);
  void restartAll(const ScriptProcess& gone);
  void restart(Key key, Script& script, const std::string& why);
  void stopRemote(Script& script);
  void discard(const ProcessRef& process, double first, wire::Clock::time_point until);
  void serveLate();

  void flush(Script& script);
  void deliver(Script& script, const FieldInfo& in, const Value& value);
  Script* find(XsNode self);
  void log(Script& script, int severity, uint32_t line, const std::string& text);
  bool overBudget(Script& script, uint64_t steps);
  void spend(std::chrono::steady_clock::duration time, double processor);
  void spendOfAll();
  bool spent() const {
    return options_.scriptPatience <= 0 &&
           (used_ >= run_.worldScriptSeconds || waited_ >= mostWaiting * run_.worldScriptSeconds);
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
  std::deque<Key> beginning_;                  // to be started, in this order
  size_t ahead_ = 0;                           // how many of them startAhead() has dealt with
  size_t sentAhead_ = 0;                       // how many are ahead of their turn
  std::vector<std::unique_ptr<Script>> ended_; // their nodes have been destroyed
  std::map<Key, bool> due_; // eventsProcessed is due; true: there are events waiting
  std::vector<Key> ticking_;
  std::vector<Key> late_;                      // to be started when their processes are not busy
  std::unique_ptr<ScriptProcesses> processes_; // null until one is needed
  std::unordered_set<std::string>
      unusable_; // engines of which it has been told that they have no process
  wire::Writer message_;
  uint32_t interpreters_ = 0; // in processes, ever
  double patience_; // seconds that calls may still wait before the next tick; below 0: hardly any
  // Of RunOptions::worldScriptSeconds: processor time, so that a busy machine stops no Script that
  // an idle one lets run. What sleeps uses none: waiting is bounded, too.
  static constexpr double mostWaiting = 10;
  double used_ = 0, waited_ = 0;   // seconds: of the processor, on the wall
  std::optional<double> lastTick_; // the world's time then
  bool toldSpent_ = false;
  ScriptCounts counts_;
  wire::Clock::time_point endBy_ = wire::never;
  XsNode lastNumber_ = 0;
  Script* running_ = nullptr;
  bool ending_ = false;  // outputs go nowhere
  bool closing_ = false; // the world ends
};

} // namespace xvrml
