// host.h: runs the Script nodes of a world (ISO/IEC 14772-1 4.12): finds their engines, brings them events, takes theirs. The
// engine of events calls it; scripts call the world through the table of functions in host_table.cpp. Owned by the Browser, ends
// before the engine of events. [the browser's thread]
#pragma once

#include <chrono>
#include <map>
#include <memory>

#include "event/engine.h"
#include "script/program.h"
#include "script/values.h"
#include "xvrml/browser.h"

namespace xvrml {

// A Script node that has an interpreter, or will have one at its turn.
struct Script {
  Script(ScriptNode& node, XsNode self, XsNode& lastNumber) : node(&node), self(self), handles(&node, self, lastNumber) {}

  struct Waiting { // an event that has not been brought yet
    const FieldInfo* in;
    Value value;
  };
  struct Output { // what the running function has sent, for when it returns
    NodeRef to;   // null: from an eventOut of the Script itself
    const FieldInfo* field;
    Value value;
  };
  bool flag(uint32_t bit) const { return info.flags & bit; }

  ScriptNode* node; // part of the world; after it has been destroyed `ghost`
  NodeRef ghost;    // keeps the fields of a node that is no more, for shutdown()
  const XsNode self;
  const XsEngine* engine = nullptr; // null: no program that could be run
  XsInterpreter interpreter = 0;
  SourcePosition start; // of the program
  std::string scheme, origin, text;
  XsScriptInfo info{};
  std::vector<XsField> fields;

  bool stopped = false; // used up its time: no more calls but shutdown and destroy
  bool failed = false;  // the running function has logged an error
  uint64_t steps = 0;   // of the running function
  std::chrono::steady_clock::time_point since;

  Handles handles;
  LentValue lent; // what XsHost gave out last
  std::string lentText, error;
  std::deque<Waiting> waiting;
  std::vector<Output> outputs;
  std::unordered_set<std::string> told; // messages, each once
};

class ScriptHost : public ScriptRunner {
 public:
  struct Table; // the XsHost that scripts get, with the way back to this
  ScriptHost(Browser& browser, Engine& engine, World& world, const BrowserOptions& options);
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

 private:
  friend struct HostTable;
  using Key = uint32_t; // order of the nodes in the world

  void start(Script& script);
  bool makeInterpreter(Script& script, ScriptProgram program);
  void stop(Script& script); // shutdown and destroy
  template <class Invoke> XsResult call(Script& script, const char* function, Invoke&& invoke);
  void flush(Script& script);
  void deliver(Script& script, const FieldInfo& in, const Value& value);
  Script* find(XsNode self);
  void log(Script& script, int severity, uint32_t line, const std::string& text);
  bool overBudget(Script& script, uint64_t steps);
  void markReach(Script& script);

  Browser& browser_;
  Engine& engine_;
  World& world_;
  const BrowserOptions& options_;
  ProgramFinder programs_;
  std::unique_ptr<Table> table_;
  std::map<Key, std::unique_ptr<Script>> scripts_;
  std::unordered_map<XsNode, Script*> bySelf_;
  std::deque<Key> beginning_;
  std::vector<std::unique_ptr<Script>> ended_; // their nodes have been destroyed
  std::map<Key, bool> due_;                    // eventsProcessed is due; true: there are events waiting
  std::vector<Key> ticking_;
  XsNode lastNumber_ = 0;
  Script* running_ = nullptr;
  bool ending_ = false; // outputs go nowhere
};

} // namespace xvrml
