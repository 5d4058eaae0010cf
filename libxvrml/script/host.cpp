// host.cpp: the life of Scripts: begin, events, end. See host.h.
#include "script/host.h"

#include <algorithm>

#include <fmt/format.h>

#include "parse/field_access.h"
#include "script/host_table.h"

namespace xvrml {
namespace {

bool flagOf(const ScriptNode& node, std::string_view name) {
  const FieldInfo* field = node.type().find(name);
  return field && field->type == FieldType::SFBool && std::get<bool>(node.get(*field));
}

bool isOwn(const FieldInfo& field) { return field.name != "url" && field.name != "directOutput" && field.name != "mustEvaluate"; }

} // namespace

ScriptHost::ScriptHost(Browser& browser, Engine& engine, World& world, const BrowserOptions& options)
    : browser_(browser), engine_(engine), world_(world), options_(options),
      programs_(scriptFolders(options.scriptPath), world.diagnostics, options.trustScripts),
      table_(std::make_unique<Table>(*this)) {}

ScriptHost::~ScriptHost() {
  engine_.scripts = nullptr;
  ending_ = true;
  finish();
  for (auto& [order, script] : scripts_) stop(*script);
  scripts_.clear(); // handles may be the last to hold nodes, and nodes Scripts: nothing of them runs any more
}

void ScriptHost::begin(ScriptNode& node) {
  const Key key = liveOf(node)->order;
  const XsNode self = ++lastNumber_;
  auto script = std::make_unique<Script>(node, self, lastNumber_);
  bySelf_.emplace(script->self, script.get());
  scripts_.emplace(key, std::move(script));
  beginning_.push_back(key);
}

// 4.12.3: before any event reaches it.
bool ScriptHost::initializeNext() {
  if (beginning_.empty()) return false;
  const Key key = beginning_.front();
  beginning_.pop_front();
  if (const auto found = scripts_.find(key); found != scripts_.end()) start(*found->second);
  return true;
}

void ScriptHost::start(Script& script) {
  for (size_t next = 0;;) {
    ScriptProgram program = programs_.find(*script.node, world_.options, next);
    if (!program.engine) return;
    next = program.url + 1;
    if (makeInterpreter(script, std::move(program))) break;
    if (script.stopped) return;
  }
  if (script.ghost) return; // the program has let go of the last that held its own node
  if (script.flag(XS_DIRECT_OUTPUT)) markReach(script);
  const Key key = liveOf(*script.node)->order;
  if (script.engine->tick) ticking_.push_back(key);
  if (!script.engine->initialize) return;
  call(script, "initialize", [&] { return script.engine->initialize(script.interpreter, engine_.now()); });
}

bool ScriptHost::makeInterpreter(Script& script, ScriptProgram program) {
  script.engine = program.engine;
  script.start = program.start;
  script.scheme = std::move(program.scheme);
  script.text = std::move(program.text);
  script.origin = script.start.file ? *script.start.file : world_.path;
  script.fields.clear();
  for (const FieldInfo& field : script.node->type().fields)
    if (isOwn(field)) script.fields.push_back({field.name.c_str(), xsType(field.type), xsAccess(field.access)});
  XsScriptInfo& info = script.info;
  info.size = sizeof(XsScriptInfo);
  info.flags = (flagOf(*script.node, "directOutput") ? uint32_t(XS_DIRECT_OUTPUT) : 0u) |
               (flagOf(*script.node, "mustEvaluate") ? uint32_t(XS_MUST_EVALUATE) : 0u) |
               (options_.trustScripts ? uint32_t(XS_TRUSTED) : 0u) | (options_.allowNetwork ? uint32_t(XS_NETWORK) : 0u);
  info.self = script.self;
  info.scheme = script.scheme.c_str();
  info.origin = script.origin.c_str();
  info.text = {script.text.c_str(), script.text.size()};
  info.fieldCount = uint32_t(script.fields.size());
  info.fields = script.fields.data();
  info.memory = options_.scriptMemory;
  bool made = false;
  const XsResult result = call(script, "create", [&] {
    const XsResult answer = script.engine->create(table_.get(), &script.info, &script.interpreter);
    made = answer == XS_OK;
    return answer;
  });
  if (made && result != XS_OK) script.engine->destroy(script.interpreter); // stopped
  if (result != XS_OK) script.engine = nullptr;
  return result == XS_OK;
}

// The nodes a Script with directOutput refers to can be changed by it in any way (6.40).
void ScriptHost::markReach(Script& script) {
  forEachChild(*script.node, [&](NodeRef& child, const FieldInfo& field) {
    for (const FieldInfo& in : child->type().fields)
      if (in.access == Access::exposedField || in.access == Access::eventIn)
        engine_.markReach(*child, in, fmt::format("Script field {}", field.name));
  });
}

void ScriptHost::stop(Script& script) {
  if (!script.engine) return;
  const XsEngine& engine = *script.engine;
  script.waiting.clear();
  if (engine.shutdown) {
    const bool ending = std::exchange(ending_, true);
    call(script, "shutdown", [&] { return engine.shutdown(script.interpreter, engine_.now()); });
    ending_ = ending;
  }
  engine.destroy(script.interpreter);
  script.engine = nullptr;
  script.handles.clear();
}

// Every call into an engine: its time is counted, what it sent leaves when it has returned.
template <class Invoke> XsResult ScriptHost::call(Script& script, const char* function, Invoke&& invoke) {
  const NodeRef keep(script.node);
  script.steps = 0;
  script.failed = false;
  script.since = std::chrono::steady_clock::now();
  Script* const outer = std::exchange(running_, &script);
  const bool wasStopped = std::exchange(script.stopped, false);
  const XsResult result = invoke();
  running_ = outer;
  if (script.stopped || result == XS_STOPPED) {
    script.stopped = true;
    script.outputs.clear();
    log(script, 3, 0, fmt::format("{} took too long: the Script is stopped", function));
  } else if (result != XS_OK && !script.failed) {
    log(script, 3, 0, fmt::format("{} failed", function));
  }
  script.stopped = script.stopped || wasStopped;
  flush(script);
  script.lent.clear();
  script.handles.endCall();
  return script.stopped && !wasStopped ? XS_STOPPED : result;
}

void ScriptHost::flush(Script& script) {
  for (Script::Output& output : std::exchange(script.outputs, {})) {
    if (ending_ || script.ghost) continue;
    if (output.to)
      engine_.post(*output.to, *output.field, std::move(output.value));
    else
      engine_.send(*script.node, *output.field, std::move(output.value));
  }
}

void ScriptHost::receive(ScriptNode& node, const FieldInfo& in, const Value& value) {
  const Key key = liveOf(node)->order;
  const auto found = scripts_.find(key);
  if (found == scripts_.end()) return;
  Script& script = *found->second;
  if (in.name == "url") { // another program (6.40)
    stop(script);
    script.stopped = false;
    std::erase(ticking_, key);
    due_.erase(key);
    node.urlLines.clear();
    beginning_.push_back(key);
    engine_.scriptsBegin();
    return;
  }
  if (!isOwn(in) || !script.engine || script.stopped) return;
  const bool atOnce = script.flag(XS_MUST_EVALUATE) && script.waiting.empty();
  bool& waits = due_[key];
  if (atOnce) return deliver(script, in, value);
  waits = true;
  script.waiting.push_back({&in, value});
}

void ScriptHost::deliver(Script& script, const FieldInfo& in, const Value& value) {
  if (!script.engine || !script.engine->event || script.stopped) return;
  const auto named =
      std::find_if(script.fields.begin(), script.fields.end(), [&](const XsField& f) { return f.name == in.name; });
  call(script, "event", [&] {
    LentValue event;
    const XsEvent told{sizeof(XsEvent), uint32_t(named - script.fields.begin()), in.name.c_str(),
                       event.lend(value, script.handles), engine_.now()};
    return script.engine->event(script.interpreter, &told);
  });
}

// mustEvaluate FALSE: events wait until nothing else is left to do in the cascade; they keep their order.
bool ScriptHost::eventsProcessed() {
  if (due_.empty()) return false;
  for (const auto& [key, waits] : std::exchange(due_, {})) {
    const auto found = scripts_.find(key);
    if (found == scripts_.end()) continue;
    Script& script = *found->second;
    for (const Script::Waiting& event : std::exchange(script.waiting, {})) deliver(script, *event.in, event.value);
    if (script.engine && !script.stopped && script.engine->eventsProcessed)
      call(script, "eventsProcessed", [&] { return script.engine->eventsProcessed(script.interpreter, engine_.now()); });
  }
  return true;
}

void ScriptHost::drop() {
  for (const auto& [key, waits] : std::exchange(due_, {}))
    if (const auto found = scripts_.find(key); found != scripts_.end()) found->second->waiting.clear();
}

void ScriptHost::tick() {
  for (const Key key : std::vector<Key>(ticking_)) {
    const auto found = scripts_.find(key);
    if (found == scripts_.end() || !found->second->engine || found->second->stopped) continue;
    Script& script = *found->second;
    call(script, "tick", [&] { return script.engine->tick(script.interpreter, engine_.now()); });
  }
}

// The node is being destroyed, in the middle of whatever let go of it: a copy keeps its fields until shutdown can be called.
void ScriptHost::end(ScriptNode& node) noexcept {
  const auto found = scripts_.find(liveOf(node)->order);
  if (found == scripts_.end()) return;
  try {
    std::unique_ptr<Script> script = std::move(found->second);
    std::erase(ticking_, found->first);
    due_.erase(found->first);
    scripts_.erase(found);
    auto* ghost = new ScriptNode(node.typePtr);
    script->ghost = NodeRef(ghost);
    ghost->values = std::move(node.values);
    node.values = std::vector<Value>(ghost->values.size()); // those who read them meanwhile find some
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field)) node.values[field.offset] = defaultValue(field.type);
    ghost->source = node.source;
    ghost->defName = node.defName;
    script->node = ghost;
    script->handles.setOwn(ghost);
    script->waiting.clear();
    ended_.push_back(std::move(script));
  } catch (const std::bad_alloc&) {} // no shutdown then
}

void ScriptHost::finish() {
  while (!ended_.empty()) {
    const std::vector<std::unique_ptr<Script>> ended = std::exchange(ended_, {});
    for (const auto& script : ended) {
      stop(*script);
      bySelf_.erase(script->self);
    }
  }
}

Script* ScriptHost::find(XsNode self) {
  const auto found = bySelf_.find(self);
  return found == bySelf_.end() ? nullptr : found->second;
}

bool ScriptHost::overBudget(Script& script, uint64_t steps) {
  script.steps = saturatingAdd(script.steps, steps);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - script.since;
  if (script.steps > options_.scriptSteps || taken.count() > options_.scriptSeconds) script.stopped = true;
  return script.stopped;
}

void ScriptHost::log(Script& script, int severity, uint32_t line, const std::string& text) {
  constexpr size_t most = 100; // messages of one Script
  script.failed = script.failed || severity >= 3;
  if (severity <= 0 && options_.print) return options_.print(text);
  if (script.told.size() > most || !script.told.insert(fmt::format("{} {}", line, text.substr(0, 2000))).second) return;
  Diagnostic d;
  d.severity = severity <= 1 ? Severity::note : severity == 2 ? Severity::warning : Severity::error;
  const SourcePosition& place = line > 0 ? script.start : script.node->source;
  d.file = place.file ? *place.file : world_.path;
  d.line = line > 0 ? place.line + line - 1 : place.line;
  d.column = line > 0 ? 0 : place.column;
  const std::string& name = script.node->defName;
  d.message = script.told.size() > most ? "Script: more messages than can be read; the rest is left out"
                                        : fmt::format("Script{}{}: {}", name.empty() ? "" : " ", name, text.substr(0, 2000));
  world_.diagnostics.add(std::move(d));
}

} // namespace xvrml
