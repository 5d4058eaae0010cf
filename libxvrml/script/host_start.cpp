// host_start.cpp: starts Scripts: one after the other as seen by the world, in parallel in their
// processes. Part of ScriptHost. [the browser's thread]
#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "script/host.h"

namespace xvrml {
namespace {

bool flagOf(const ScriptNode& node, std::string_view name) {
  const FieldInfo* field = node.type().find(name);
  return field && field->type == FieldType::SFBool && std::get<bool>(node.get(*field));
}

bool wantsTicks(const Script& script) {
  const char* const word = script.engine->tickWord;
  return script.engine->tick && (!word || script.text.find(word) != std::string::npos);
}

// Returns how many Scripts start in parallel: two per processor, so that one computes while the
// browser serves another. More would only compete for time and memory.
size_t parallelStarts() {
  const size_t processors = std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<size_t>(2 * processors, 4, ScriptProcesses::most);
}

} // namespace

void ScriptHost::begin(ScriptNode& node) {
  const Key key = liveOf(node)->order;
  const XsNode self = ++lastNumber_;
  if (const size_t all = scripts_.size() + ended_.size() + 1; ended_.capacity() < all)
    ended_.reserve(2 * all); // for end()
  const auto place =
      scripts_.emplace(key, std::make_unique<Script>(key, node, self, lastNumber_)).first;
  bySelf_.emplace(self, place->second.get());
  startQueue_.push_back(key);
  ++counts_.scripts;
}

// Starts the next Script. It runs before any event reaches the Script (4.12.3).
bool ScriptHost::initializeNext() {
  if (isTimeUsedUp()) stopAll();
  if (startQueue_.empty()) return false;
  startEarly();
  const Key key = startQueue_.front();
  startQueue_.pop_front();
  earlyHandled_ -= std::min<size_t>(earlyHandled_, 1);
  if (const auto found = scripts_.find(key); found != scripts_.end()) {
    Script& script = *found->second;
    start(script);
    if (earlyStarts_ > 0) chargeProcesses();
    if (!script.waiting.empty()) due_[key] = true; // events that have arrived meanwhile
  }
  if (run_.onScriptStart) {
    ScriptCounts current = counts_;
    current.waiting = startQueue_.size();
    run_.onScriptStart(current);
  }
  return true;
}

// Sends `create` early. A process makes an interpreter and runs initialize() while the browser
// serves others. The program's requests to the browser wait for the Script's turn. So the world
// sees the same calls in the same order as without early starts.
void ScriptHost::startEarly() {
  static const size_t most = parallelStarts();
  for (; earlyHandled_ < startQueue_.size() && earlyStarts_ < most; ++earlyHandled_) {
    const auto found = scripts_.find(startQueue_[earlyHandled_]);
    if (found == scripts_.end()) continue;
    Script& script = *found->second;
    const bool first = !script.engine && !script.stopped && !script.nodeCopy && script.nextUrl == 0;
    if (first && !sendCreateEarly(script)) return;
  }
}

// Returns false if the Script has to wait for a process. A start that cannot be sent early, or
// fails, is repeated at the Script's turn.
bool ScriptHost::sendCreateEarly(Script& script) {
  if (options_.scriptIsolation == BrowserOptions::Isolation::never) return true;
  ScriptProgram program = programs_.peek(*script.node, world_.options);
  if (!program.engine || !isolated(*program.engine)) return true;
  std::string why;
  const ProcessRef process =
      chooseProcess(*program.engine, startQueue_.size() - earlyHandled_ - 1, why);
  if (!process || process->busy()) return !process;
  const size_t url = program.url;
  XsResult result = XS_FAILED;
  try {
    describe(script, std::move(program));
    result = beginCreate(script, process);
  } catch (...) {
    dropInterpreter(script);
    throw;
  }
  if (result != later) {
    detach(script);
    if (result == again) restartAll(*process);
    return true;
  }
  script.nextUrl = url + 1;
  script.startedEarly = true;
  ++earlyStarts_;
  return true;
}

void ScriptHost::start(Script& script) {
  script.startPending = false;
  if (script.startedEarly) {
    script.startedEarly = false;
    --earlyStarts_;
    programs_.reportRefusals();
    const XsResult result = waitFor(script);
    if (result == later || created(script, result)) return;
  }
  while (!script.stopped && !script.engine && !script.nodeCopy) {
    ScriptProgram program = programs_.find(*script.node, world_.options, script.nextUrl);
    if (!program.engine) return;
    const size_t url = program.url;
    script.nextUrl = url + 1;
    const XsResult result = makeInterpreter(script, std::move(program));
    if (result == later) return;
    if (result == again) {
      script.nextUrl = url;
      if (script.startPending) return;
    } else if (created(script, result)) {
      return;
    }
  }
}

// Continues after `create`. Returns false if it failed.
bool ScriptHost::created(Script& script, XsResult result) {
  if (result != XS_OK) {
    if (script.process) detach(script);
    script.engine = nullptr;
    return false;
  }
  counts_.started += !std::exchange(script.counted, true);
  // Its process has continued with initialize by itself.
  const bool initializing = script.pending == wire::Op::initialize;
  if (!script.nodeCopy) {
    if (script.flag(XS_DIRECT_OUTPUT)) markReach(script);
    if (wantsTicks(script)) ticking_.push_back(script.key);
  }
  if (initializing) {
    waitFor(script);
  } else if (!script.nodeCopy &&
             !isTimeUsedUp()) { // else the program has released the last reference to its own node
    plainCall(script, wire::Op::initialize, &XsEngine::initialize);
  }
  return true;
}

// Fills in the description of the Script for the engine.
void ScriptHost::describe(Script& script, ScriptProgram program) {
  script.engine = program.engine;
  script.start = program.start;
  script.scheme = std::move(program.scheme);
  script.text = std::move(program.text);
  script.origin = script.start.file ? *script.start.file : world_.path;
  script.fields.clear();
  for (const FieldInfo& field : script.node->type().fields)
    if (Script::isOwn(field))
      script.fields.push_back({field.name.c_str(), xsType(field.type), xsAccess(field.access)});
  XsScriptInfo& info = script.info;
  info.size = sizeof(XsScriptInfo);
  info.flags =
      (flagOf(*script.node, "directOutput") || run_.directOutputAlways ? uint32_t(XS_DIRECT_OUTPUT)
                                                                       : 0u) |
      (flagOf(*script.node, "mustEvaluate") ? uint32_t(XS_MUST_EVALUATE) : 0u) |
      (options_.trustScripts ? uint32_t(XS_TRUSTED) : 0u) |
      (options_.allowNetwork ? uint32_t(XS_NETWORK) : 0u);
  info.self = script.self;
  info.scheme = script.scheme.c_str();
  info.origin = script.origin.c_str();
  info.text = {script.text.c_str(), script.text.size()};
  info.fieldCount = uint32_t(script.fields.size());
  info.fields = script.fields.data();
  info.memory = options_.scriptMemory;
}

// Drops the interpreter of a Script, so that it is not shut down.
void ScriptHost::dropInterpreter(Script& script) {
  if (script.process) detach(script);
  script.engine = nullptr;
}

XsResult ScriptHost::makeInterpreter(Script& script, ScriptProgram program) {
  const XsEngine* const engine = program.engine;
  bool made = false;
  try {
    describe(script, std::move(program));
    if (isolated(*engine)) return createRemote(script);
    const XsResult result = call(script, "create", [&] {
      const XsResult answer = engine->create(table(), &script.info, &script.interpreter);
      made = answer == XS_OK;
      return answer;
    });
    if (made && result != XS_OK) engine->destroy(script.interpreter); // the program was stopped
    return result;
  } catch (...) { // memory is exhausted
    if (made) engine->destroy(script.interpreter);
    dropInterpreter(script);
    throw;
  }
}

ScriptCounts ScriptHost::counts() const {
  ScriptCounts counts = counts_;
  counts.waiting = startQueue_.size() + waitingForProcess_.size();
  for (const auto& [key, script] : scripts_) {
    const bool starting =
        script->pending == wire::Op::create || script->pending == wire::Op::initialize;
    counts.waiting += starting && !script->startedEarly;
  }
  return counts;
}

// --- Limits of all Scripts together ---

void ScriptHost::chargeTime(std::chrono::steady_clock::duration time, double processor) {
  const double seconds = std::chrono::duration<double>(time).count();
  used_ += processor;
  waited_ += seconds;
  counts_.seconds += seconds;
  ++counts_.calls;
}

// Charges the processor time of processes whose Scripts start early.
void ScriptHost::chargeProcesses() {
  for (const ProcessRef& process : processes_->all()) used_ += process->takeProcessorTime();
}

// Ends all Scripts, because they have used up the world's time. Must not be called while a function
// of one runs.
void ScriptHost::stopAll() {
  const std::unordered_set<Key> beginning(startQueue_.begin(), startQueue_.end());
  uint64_t stopped = 0;
  std::vector<NodeRef> kept; // without their handles, Scripts may lose their last references
  for (const auto& [key, script] : scripts_) kept.emplace_back(script->node);
  for (const auto& [key, script] : scripts_) {
    if (script->stopped) continue;
    if (!script->engine && !script->startPending && !beginning.contains(key)) continue;
    script->stopped = true;
    script->waiting.clear();
    script->outputs.clear();
    script->startPending = script->eventsProcessedDue = script->startedEarly = false;
    if (script->process) detach(*script);
    ++stopped;
  }
  startQueue_.clear();
  waitingForProcess_.clear();
  due_.clear();
  ticking_.clear();
  earlyHandled_ = earlyStarts_ = 0;
  if (processes_)
    for (const ProcessRef& process : processes_->all()) process->kill("is not needed any more");
  if (stopped == 0 || std::exchange(limitReported_, true)) return;
  const double limit = run_.worldScriptSeconds;
  Diagnostic d;
  d.file = world_.path;
  d.message =
      fmt::format("Scripts have taken {:.1f} s together, limit worldScriptSeconds={}: {} of {} "
                  "Scripts are stopped (vv --limit worldScriptSeconds={} lets them run longer)",
                  used_ >= limit ? used_ : waited_, limit, stopped, counts_.scripts,
                  std::max(10 * limit, 60.0));
  world_.diagnostics.add(std::move(d));
}

} // namespace xvrml
