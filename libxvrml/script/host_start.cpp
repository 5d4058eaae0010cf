// host_start.cpp: how Scripts start: one after the other as far as the world can tell, side by side
// in their processes. Part of ScriptHost; see host.h. [the browser's thread]
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

// Two for each processor: one computes while the browser answers another. More would only take time
// and memory from each other.
size_t sideBySide() {
  const size_t processors = std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<size_t>(2 * processors, 4, ScriptProcesses::most);
}

} // namespace

void ScriptHost::begin(ScriptNode& node) {
  const Key key = liveOf(node)->order;
  const XsNode self = ++lastNumber_;
  const auto place = scripts_.emplace(key, std::make_unique<Script>(node, self, lastNumber_)).first;
  bySelf_.emplace(self, place->second.get());
  beginning_.push_back(key);
  ++counts_.scripts;
}

// 4.12.3: before any event reaches it.
bool ScriptHost::initializeNext() {
  if (spent()) stopAll();
  if (beginning_.empty()) return false;
  startAhead();
  const Key key = beginning_.front();
  beginning_.pop_front();
  ahead_ -= std::min<size_t>(ahead_, 1);
  if (const auto found = scripts_.find(key); found != scripts_.end()) {
    Script& script = *found->second;
    start(script);
    if (sentAhead_ > 0) spendOfAll();
    if (!script.waiting.empty()) due_[key] = true; // events that came meanwhile
  }
  if (run_.onScriptStart) {
    ScriptCounts told = counts_;
    told.waiting = beginning_.size();
    run_.onScriptStart(told);
  }
  return true;
}

// A process makes an interpreter and runs initialize() while the browser looks after others. All
// that a program asks of the browser waits for the Script's turn: the world sees the same calls in
// the same order as if each had been sent at its turn.
void ScriptHost::startAhead() {
  static const size_t most = sideBySide();
  for (; ahead_ < beginning_.size() && sentAhead_ < most; ++ahead_) {
    const auto found = scripts_.find(beginning_[ahead_]);
    if (found == scripts_.end()) continue;
    Script& script = *found->second;
    const bool first = !script.engine && !script.stopped && !script.ghost && script.nextUrl == 0;
    if (first && !sendAhead(script)) return;
  }
}

// False if it has to wait for a process. What cannot be sent ahead, or goes wrong, is done again at
// the Script's turn.
bool ScriptHost::sendAhead(Script& script) {
  if (options_.scriptIsolation == BrowserOptions::Isolation::never) return true;
  ScriptProgram program = programs_.peek(*script.node, world_.options);
  if (!program.engine || !isolated(*program.engine)) return true;
  std::string why;
  const ProcessRef process = chooseProcess(*program.engine, beginning_.size() - ahead_ - 1, why);
  if (!process || process->busy()) return !process;
  const size_t url = program.url;
  XsResult result = XS_FAILED;
  try {
    describe(script, std::move(program));
    result = beginCreate(script, process);
  } catch (...) {
    giveUp(script);
    throw;
  }
  if (result != later) {
    detach(script);
    if (result == again) restartAll(*process);
    return true;
  }
  script.nextUrl = url + 1;
  script.ahead = true;
  ++sentAhead_;
  return true;
}

void ScriptHost::start(Script& script) {
  script.expected = false;
  if (script.ahead) {
    script.ahead = false;
    --sentAhead_;
    programs_.tellRefusals();
    const XsResult result = waitFor(script);
    if (result == later || created(script, result)) return;
  }
  while (!script.stopped && !script.engine && !script.ghost) {
    ScriptProgram program = programs_.find(*script.node, world_.options, script.nextUrl);
    if (!program.engine) return;
    const size_t url = program.url;
    script.nextUrl = url + 1;
    const XsResult result = makeInterpreter(script, std::move(program));
    if (result == later) return;
    if (result == again) {
      script.nextUrl = url;
      if (script.expected) return;
    } else if (created(script, result)) {
      return;
    }
  }
}

// What follows on `create`. False if it failed.
bool ScriptHost::created(Script& script, XsResult result) {
  if (result != XS_OK) {
    if (script.process) detach(script);
    script.engine = nullptr;
    return false;
  }
  counts_.started += !std::exchange(script.counted, true);
  const bool initializing =
      script.pending == wire::Op::initialize; // its process has gone on by itself
  if (!script.ghost) {
    if (script.flag(XS_DIRECT_OUTPUT)) markReach(script);
    if (script.engine->tick) ticking_.push_back(liveOf(*script.node)->order);
  }
  if (initializing) {
    waitFor(script);
  } else if (!script.ghost &&
             !spent()) { // else the program has let go of the last that held its own node
    plainCall(script, wire::Op::initialize, &XsEngine::initialize);
  }
  return true;
}

// Sets all that the engine is told of the Script.
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

// The Script has no interpreter: nobody is to shut it down.
void ScriptHost::giveUp(Script& script) {
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
    if (made && result != XS_OK) engine->destroy(script.interpreter); // stopped
    return result;
  } catch (...) { // out of memory
    if (made) engine->destroy(script.interpreter);
    giveUp(script);
    throw;
  }
}

ScriptCounts ScriptHost::counts() const {
  ScriptCounts counts = counts_;
  counts.waiting = beginning_.size() + late_.size();
  for (const auto& [key, script] : scripts_) {
    const bool starting =
        script->pending == wire::Op::create || script->pending == wire::Op::initialize;
    counts.waiting += starting && !script->ahead;
  }
  return counts;
}

// --- What Scripts may take together ---

void ScriptHost::spend(std::chrono::steady_clock::duration time, double processor) {
  const double seconds = std::chrono::duration<double>(time).count();
  used_ += processor;
  waited_ += seconds;
  counts_.seconds += seconds;
  ++counts_.calls;
}

// Counts what the processes have used whose Scripts start ahead of their turn.
void ScriptHost::spendOfAll() {
  for (const ProcessRef& process : processes_->all()) used_ += process->takeProcessorTime();
}

// Ends all Scripts: they have used up what the world may take. Not while a function of one runs.
void ScriptHost::stopAll() {
  const std::unordered_set<Key> beginning(beginning_.begin(), beginning_.end());
  uint64_t stopped = 0;
  for (const auto& [key, script] : scripts_) {
    if (script->stopped) continue;
    if (!script->engine && !script->expected && !beginning.contains(key)) continue;
    script->stopped = true;
    script->waiting.clear();
    script->outputs.clear();
    script->expected = script->owed = script->ahead = false;
    if (script->process) detach(*script);
    ++stopped;
  }
  beginning_.clear();
  late_.clear();
  due_.clear();
  ticking_.clear();
  ahead_ = sentAhead_ = 0;
  if (processes_)
    for (const ProcessRef& process : processes_->all()) process->kill("is not needed any more");
  if (stopped == 0 || std::exchange(toldSpent_, true)) return;
  const double limit = run_.worldScriptSeconds;
  Diagnostic d;
  d.file = world_.path;
  d.message = fmt::format("Scripts have taken {:.1f} s together, limit worldScriptSeconds={}: {} "
                          "of {} Scripts are stopped "
                          "(vv --limit worldScriptSeconds={} lets them run longer)",
                          used_ >= limit ? used_ : waited_, limit, stopped, counts_.scripts,
                          std::max(10 * limit, 60.0));
  world_.diagnostics.add(std::move(d));
}

} // namespace xvrml
