// host.cpp: the life of Scripts: begin, events, end.
#include "script/host.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>

#include "graph/expander.h"
#include "graph/field_access.h"
#include "script/host_table.h"
#include "thread_clock.h"

namespace xvrml {
namespace {

uint64_t bytesOf(const Value& value) {
  return std::visit(
      [&](const auto& v) { return sizeof v + valueBytes(FieldType(value.index()), &v); }, value);
}

// Returns the node of a Script that cannot have one of its own: it has no fields.
NodeRef makeNobody() {
  auto type = std::make_shared<NodeType>();
  type->name = "Script";
  type->index = ScriptNode::typeIndex;
  return NodeRef(new ScriptNode(std::move(type)));
}

} // namespace

ScriptHost::ScriptHost(Browser& browser, Engine& engine, World& world,
                       const BrowserOptions& options, const RunOptions& run)
    : browser_(browser), engine_(engine), world_(world), options_(options), run_(run),
      programs_(scriptFolders(options.scriptPath), world.diagnostics, options.trustScripts),
      table_(std::make_unique<Table>(*this)), nobody_(makeNobody()),
      patience_(options.scriptPatience) {}

// Ends all Scripts. Each is held with its node until the last has been shut down, because handles
// may hold the last reference to nodes, and nodes to Scripts.
ScriptHost::~ScriptHost() {
  ending_ = closing_ = true;
  // Seconds that shutdown() may take; the user waits no longer for a window to close.
  constexpr double grace = 0.25;
  patience_ = options_.scriptPatience > 0 ? grace : 0;
  shutdownDeadline_ =
      wire::Clock::now() +
      std::chrono::milliseconds(int64_t(1000 * std::clamp(options_.scriptSeconds, grace, 1e6)));
  for (auto& [order, script] : scripts_) script->heldUntilStop = NodeRef(script->node);
  const auto attempt = [](const auto& step) {
    try {
      step();
    } catch (const std::exception&) {} // no memory: the other Scripts are still ended
  };
  attempt([&] { finish(); });
  for (auto& [order, script] : scripts_) {
    attempt([&, order = order] { shutDownEarly(order); }); // else it is shut down at its own turn
    attempt([&, &script = *script] { stop(script); });
  }
  processes_.reset();
  // No Script runs any more. Their nodes go now, and nobody needs to know.
  engine_.scripts = nullptr;
  ended_.clear();
  scripts_.clear();
}

const XsHost* ScriptHost::table() const { return table_.get(); }

// Marks the nodes that a Script with directOutput refers to: it can change them in any way (6.40).
void ScriptHost::markReach(Script& script) {
  forEachChild(*script.node, [&](NodeRef& child, const FieldInfo& field) {
    for (const FieldInfo& in : child->type().fields)
      if (in.access == Access::exposedField || in.access == Access::eventIn)
        engine_.markReach(*child, in, fmt::format("Script field {}", field.name));
  });
}

// Ends a Script, which afterwards has no interpreter and no handles. If shutdown() runs out of
// memory, the interpreter is destroyed all the same.
void ScriptHost::stop(Script& script) {
  script.waiting.clear();
  script.startPending = script.eventsProcessedDue = false;
  if (std::exchange(script.startedEarly, false)) --earlyStarts_;
  if (!script.engine) return;
  const bool ending = ending_;
  if (script.process) {
    try {
      return stopRemote(script);
    } catch (const std::exception&) {
      ending_ = ending;
      if (script.process) detach(script);
      return;
    }
  }
  ending_ = true;
  try {
    if (!isTimeUsedUp()) plainCall(script, wire::Op::shutdown, &XsEngine::shutdown);
  } catch (const std::exception&) {}
  ending_ = ending;
  script.engine->destroy(script.interpreter);
  script.engine = nullptr;
  script.handles.clear();
}

void ScriptHost::enter(Script& script) {
  script.steps = 0;
  script.failed = false;
  script.since = std::chrono::steady_clock::now();
  script.processor = threadSeconds();
  script.wasStopped = std::exchange(script.stopped, false);
}

XsResult ScriptHost::leave(Script& script, const char* function, XsResult result) {
  if (!script.process)
    chargeTime(std::chrono::steady_clock::now() - script.since, threadSeconds() - script.processor);
  if (script.stopped || result == XS_STOPPED) {
    script.stopped = true;
    script.outputs.clear();
    log(script, 3, 1, fmt::format("{} took too long: the Script is stopped", function));
  } else if (result != XS_OK && !script.failed) {
    log(script, 3, 0, fmt::format("{} failed", function));
  }
  script.stopped = script.stopped || script.wasStopped;
  flush(script);
  script.lent.clear();
  script.handles.endCall();
  return script.stopped && !script.wasStopped ? XS_STOPPED : result;
}

// Calls a function that takes only the time. Engines may lack it.
XsResult ScriptHost::plainCall(Script& script, wire::Op op, Function function) {
  if (!(script.engine->*function)) return XS_OK;
  if (script.process) {
    message_.begin(op, script.number, engine_.now());
    return callRemote(script, op, message_);
  }
  return call(script, wire::functionName(op),
              [&] { return (script.engine->*function)(script.interpreter, engine_.now()); });
}

void ScriptHost::flush(Script& script) {
  for (Script::Output& output : std::exchange(script.outputs, {})) {
    if (ending_ || script.nodeCopy) continue;
    if (output.to)
      engine_.post(*output.to, *output.field, std::move(output.value));
    else
      engine_.send(*script.node, *output.field, std::move(output.value));
  }
}

void ScriptHost::receive(ScriptNode& node, const FieldInfo& in, const Value& value) {
  if (isTimeUsedUp()) stopAll();
  const Key key = liveOf(node)->order;
  const auto found = scripts_.find(key);
  if (found == scripts_.end()) return;
  Script& script = *found->second;
  if (&in == script.url) { // another program (6.40)
    stop(script);
    script.stopped = false;
    script.nextUrl = 0;
    script.startPending = true;
    std::erase(ticking_, key);
    due_.erase(key);
    node.urlLines.clear();
    startQueue_.push_back(key);
    engine_.requestScriptStart();
    return;
  }
  if (in.isMetadata || script.stopped || (!script.engine && !script.startPending)) return;
  const bool atOnce = script.flag(XS_MUST_EVALUATE) && script.waiting.empty() && script.ready();
  bool& waits = due_[key];
  if (atOnce) return deliver(script, in, value);
  waits = true;
  queue(script, in, value);
}

// Queues an event. While a function of the Script is running in its process, every tick adds
// events, so the queue is limited.
void ScriptHost::queue(Script& script, const FieldInfo& in, const Value& value) {
  constexpr size_t maxEvents = 1000;
  constexpr uint64_t maxBytes = 64 << 20;
  if (script.waiting.empty()) script.waitingBytes = 0;
  const uint64_t bytes = bytesOf(value);
  script.waiting.push_back({&in, value, bytes});
  script.waitingBytes += bytes;
  if (script.ready()) return; // they are delivered in this cascade
  while (script.waiting.size() > maxEvents ||
         (script.waitingBytes > maxBytes && script.waiting.size() > 1)) {
    script.waitingBytes -= script.waiting.front().bytes;
    script.waiting.pop_front();
    if (script.dropped++ == 0)
      log(script, 2, 0, "is still busy: the oldest of the events that wait for it are dropped");
  }
}

void ScriptHost::deliver(Script& script, const FieldInfo& in, const Value& value) {
  if (!script.ready() || !script.engine->event) return;
  // Both names are the same string of the Script's type.
  const auto named = std::find_if(script.fields.begin(), script.fields.end(),
                                  [&](const XsField& f) { return f.name == in.name.c_str(); });
  const auto index = uint32_t(named - script.fields.begin());
  LentValue event;
  const XsValue& lent = event.lend(value, script.handles);
  if (script.process) {
    message_.begin(wire::Op::event, script.number, engine_.now());
    message_.put(index);
    message_.put(lent);
    if (callRemote(script, wire::Op::event, message_) == again) queue(script, in, value);
    return;
  }
  call(script, "event", [&] {
    const XsEvent delivered{sizeof(XsEvent), index, in.name.c_str(), lent, engine_.now()};
    return script.engine->event(script.interpreter, &delivered);
  });
}

// Delivers waiting events. With mustEvaluate FALSE events wait until nothing else is left to do in
// the cascade; they keep their order.
bool ScriptHost::eventsProcessed() {
  if (isTimeUsedUp()) stopAll();
  if (due_.empty()) return false;
  for (const auto& [key, waits] : std::exchange(due_, {})) {
    const auto found = scripts_.find(key);
    if (found == scripts_.end()) continue;
    drain(key, *found->second);
  }
  return true;
}

void ScriptHost::drain(Key key, Script& script) {
  const NodeRef keep(script.node); // a function may drop the last reference to it
  for (size_t left = script.waiting.size(); left > 0 && script.ready() && !isTimeUsedUp(); --left) {
    const Script::QueuedEvent event = std::move(script.waiting.front());
    script.waiting.pop_front();
    script.waitingBytes -= event.bytes;
    deliver(script, *event.in, event.value);
  }
  // Wait for a running call or a pending start; eventsProcessed is called afterwards.
  script.eventsProcessedDue = script.busy() || script.startPending;
  if (script.eventsProcessedDue) return;
  if (!script.waiting.empty() && script.ready()) due_[key] = true; // the Script was restarted
  if (script.ready() && !isTimeUsedUp())
    plainCall(script, wire::Op::eventsProcessed, &XsEngine::eventsProcessed);
}

void ScriptHost::drop() {
  for (const auto& [key, waits] : std::exchange(due_, {}))
    if (const auto found = scripts_.find(key); found != scripts_.end()) {
      const NodeRef keep(found->second->node); // events may hold the last reference to it
      found->second->waiting.clear();
    }
}

void ScriptHost::tick() {
  patience_ = options_.scriptPatience;
  if (isTimeUsedUp()) stopAll();
  const double passed = engine_.now() - lastTick_.value_or(engine_.now());
  used_ = std::max(0.0, used_ - passed * run_.worldScriptSeconds);
  waited_ = std::max(0.0, waited_ - passed * maxWaiting * run_.worldScriptSeconds);
  lastTick_ = engine_.now();
  if (processes_) serveRunningCalls();
  for (const Key key : std::vector<Key>(ticking_)) {
    const auto found = scripts_.find(key);
    if (found != scripts_.end() && found->second->ready() && !isTimeUsedUp())
      plainCall(*found->second, wire::Op::tick, &XsEngine::tick);
  }
}

// Handles the destruction of a node, which may happen anywhere, also while a function of the Script
// is running. The copy keeps the fields until shutdown can be called.
void ScriptHost::end(ScriptNode& node) noexcept {
  const auto found = scripts_.find(liveOf(node)->order);
  if (found == scripts_.end()) return;
  std::erase(ticking_, found->first);
  due_.erase(found->first);
  ended_.push_back(std::move(found->second)); // begin() has reserved its place
  scripts_.erase(found);
  Script& script = *ended_.back();
  script.waiting.clear();
  script.nodeCopy = nobody_;
  try {
    auto* const copy = new ScriptNode(node.typePtr);
    const NodeRef kept(copy);
    copy->values.swap(node.values); // readers of the node find the values that its type declares
    copy->source = node.source;
    copy->defName = node.defName;
    script.nodeCopy = kept;
  } catch (const std::bad_alloc&) {} // shutdown() finds no fields
  script.node = nodeCast<ScriptNode>(script.nodeCopy);
  script.handles.setOwn(script.node);
}

// Shuts down the Scripts that have ended, and frees them. Meanwhile others may end.
void ScriptHost::finish() {
  for (size_t next = 0; next < ended_.size(); ++next) {
    const std::unique_ptr<Script> script = std::move(ended_[next]);
    if (!script) continue; // finish() was left before
    stop(*script);
    bySelf_.erase(script->self);
  }
  ended_.clear();
}

Script* ScriptHost::find(XsNode self) {
  const auto found = bySelf_.find(self);
  return found == bySelf_.end() ? nullptr : found->second;
}

// Returns whether the running function has used up its time. A process has its own clock.
bool ScriptHost::isLate(const Script& script) const {
  if (script.process) return false;
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - script.since;
  const double limit = options_.scriptSeconds;
  return taken.count() > limit && (taken.count() > ScriptProcess::maximumWaitFactor * limit ||
                                   threadSeconds() - script.processor > limit);
}

bool ScriptHost::overBudget(Script& script, uint64_t steps) {
  script.steps = saturatingAdd(script.steps, steps);
  if (script.steps > options_.scriptSteps || isLate(script)) script.stopped = true;
  return script.stopped;
}

void ScriptHost::log(Script& script, int severity, uint32_t line, const std::string& text) {
  constexpr size_t most = 100; // errors per Script, and as many other messages
  script.failed = script.failed || severity >= 3;
  if (severity <= 0 && options_.print) return options_.print(text);
  std::unordered_set<std::string>& reported = severity >= 3 ? script.failures : script.reported;
  const size_t apart = severity <= 0
                           ? reported.size()
                           : 0; // every printed line counts; errors and warnings are logged once
  if (reported.size() > most ||
      !reported.insert(fmt::format("{} {} {}", line, apart, text.substr(0, 2000))).second)
    return;
  Diagnostic d;
  d.severity = severity <= 1 ? Severity::note : severity == 2 ? Severity::warning : Severity::error;
  const SourcePosition& place = line > 0 ? script.start : script.node->source;
  d.file = place.file ? *place.file : world_.path;
  d.line = line > 0 ? place.line + line - 1 : place.line;
  d.column = line > 0 ? 0 : place.column;
  const std::string& name = script.node->defName;
  d.message =
      reported.size() > most
          ? "Script: more messages than can be read; the rest is left out"
          : fmt::format("Script{}{}: {}", name.empty() ? "" : " ", name, text.substr(0, 2000));
  world_.diagnostics.add(std::move(d));
}

} // namespace xvrml
