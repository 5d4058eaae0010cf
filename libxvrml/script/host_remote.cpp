// host_remote.cpp: Scripts whose interpreters are in other processes: calling them, waiting for
// them, serving long calls, and the end of a process. Part of ScriptHost.
#include <algorithm>

#include <fmt/format.h>

#include "script/host_table.h"

namespace xvrml {

namespace {

constexpr double forEver = 1e9;
// Seconds that also a call gets for which there is no time to wait. Most calls need less.
constexpr double shortWait = 0.001;
constexpr uint32_t mostUnwaited = 32; // calls
// The time per tick for requests of all functions still running, and the time to wait for a further
// request of each.
constexpr auto tickShare = std::chrono::milliseconds(5);
constexpr double linger = 0.0002;
constexpr int maxRestarts = 3;

wire::Clock::duration durationOf(double seconds) {
  return std::chrono::duration_cast<wire::Clock::duration>(std::chrono::duration<double>(seconds));
}

} // namespace

// Returns whether Scripts of the engine get a process. Engines that need trust run in trusted
// worlds only, which are not restricted.
bool ScriptHost::isolated(const XsEngine& engine) const {
  if (engine.flags & XS_NEEDS_TRUST) return false;
  switch (options_.scriptIsolation) {
  case BrowserOptions::Isolation::never: return false;
  case BrowserOptions::Isolation::always: return true;
  case BrowserOptions::Isolation::automatic: break;
  }
  return !options_.trustScripts && !(engine.flags & XS_HARMLESS);
}

ProcessRef ScriptHost::chooseProcess(const XsEngine& engine, size_t coming, std::string& why) {
  if (!processes_) processes_ = std::make_unique<ScriptProcesses>(*table_);
  const ProcessSettings settings{libraryOf(engine), engine.name, options_.scriptSteps,
                                 options_.scriptSeconds, options_.scriptMemory};
  return processes_->choose(settings, coming, why);
}

XsResult ScriptHost::createRemote(Script& script) {
  const XsEngine& engine = *script.engine;
  std::string why;
  const ProcessRef process = chooseProcess(engine, startQueue_.size() - earlyHandled_, why);
  if (!process) {
    if (unusable_.insert(engine.name).second)
      log(script, 3, 0,
          fmt::format("no process for programs of engine {}: {}; Scripts of this engine do nothing",
                      engine.name, why));
    return XS_FAILED;
  }
  if (process->busy()) {
    script.engine = nullptr;
    script.startPending = true;
    waitingForProcess_.push_back(script.key);
    return again;
  }
  const XsResult result = beginCreate(script, process);
  if (result == again) restartAll(*process);
  return result == later ? waitFor(script) : result;
}

// Sends everything needed to make the interpreter, and to continue with initialize if the engine
// has it.
XsResult ScriptHost::beginCreate(Script& script, const ProcessRef& process) {
  XsScriptInfo& info = script.info;
  info.flags &= ~uint32_t(XS_TRUSTED | XS_NETWORK); // they have no effect there
  script.process = process;
  script.number = ++interpreters_;
  process->add();
  message_.begin(wire::Op::create, script.number, engine_.now());
  if (script.engine->initialize) message_.header().flags = wire::Flags::thenInitialize;
  message_.put(info.flags);
  message_.put(info.self);
  message_.put(info.memory);
  message_.put(info.scheme);
  message_.put(info.origin);
  message_.put(info.text);
  message_.put(info.fieldCount);
  for (const XsField& field : script.fields) message_.put(field);
  return beginCall(script, wire::Op::create, message_);
}

// --- Calls ---

// Sends a call. Returns `later`, or `again` if the process is dead and no function was running
// there.
XsResult ScriptHost::beginCall(Script& script, wire::Op op, wire::Writer& message) {
  const ProcessRef process = script.process;
  enter(script);
  if (!process->begin(message)) {
    if (process->dead()) {
      script.stopped = script.wasStopped;
      return again;
    }
    log(script, 3, 0,
        fmt::format("{}: longer than a message to a process may be", wire::functionName(op)));
    return leave(script, wire::functionName(op), XS_FAILED);
  }
  script.pending = op;
  return later;
}

XsResult ScriptHost::callRemote(Script& script, wire::Op op, wire::Writer& message) {
  const ProcessRef process = script.process;
  const XsResult result = beginCall(script, op, message);
  if (result == again) restartAll(*process);
  return result == later ? waitFor(script) : result;
}

// A fifth of the patience is kept for calls that return at once: they complete although others have
// used up the rest.
wire::Clock::time_point ScriptHost::patienceEnds() const {
  if (options_.scriptPatience <= 0) return shutdownDeadline_;
  const double kept = 0.2 * options_.scriptPatience;
  const double wait = std::clamp(patience_ - kept, std::clamp(patience_, 0.0, shortWait), 1e6);
  return std::min(shutdownDeadline_, wire::Clock::now() + durationOf(wait));
}

// Returns how long the call that has begun is waited for. A program that is often late costs the
// world its patience in one of 33 calls, not in each.
wire::Clock::time_point ScriptHost::waitEnds(const Script& script) const {
  const wire::Clock::time_point end = patienceEnds();
  const bool recurs = script.pending == wire::Op::event || script.pending == wire::Op::tick ||
                      script.pending == wire::Op::eventsProcessed;
  if (options_.scriptPatience <= 0 || ending_ || !recurs || script.unwaited == 0) return end;
  return std::min(end, wire::Clock::now() + durationOf(shortWait));
}

void ScriptHost::noteLateness(Script& script, wire::Op op, bool late) {
  if (!late) {
    if (op == script.late) script.unwaited = script.lastUnwaited = 0;
  } else if (script.unwaited > 0) {
    --script.unwaited;
  } else {
    script.late = op;
    script.unwaited = script.lastUnwaited = std::clamp(2 * script.lastUnwaited, 1U, mostUnwaited);
  }
}

// Calls between two ticks share one patience: a thousand slow Scripts cost no more than one.
XsResult ScriptHost::waitFor(Script& script) {
  const ProcessRef process = script.process;
  const wire::Op op = script.pending;
  const auto start = wire::Clock::now();
  const XsResult result = serveCall(script, forEver, forEver, waitEnds(script));
  const auto taken = wire::Clock::now() - start;
  if (options_.scriptPatience > 0) patience_ -= std::chrono::duration<double>(taken).count();
  noteLateness(script, op, result == later);
  const double seconds = std::chrono::duration<double>(taken).count();
  chargeTime(taken, process->dead() ? std::min(seconds, options_.scriptSeconds)
                                    : process->takeProcessorTime());
  return result;
}

XsResult ScriptHost::serveCall(Script& script, double first, double next,
                               wire::Clock::time_point until) {
  const NodeRef keep(script.node);
  const ProcessRef process = script.process;
  const ScriptProcess::State state =
      runAs(&script, [&] { return process->serve(first, next, until, engine_.now()); });
  if (state == ScriptProcess::State::running) return later;
  const wire::Op op = std::exchange(script.pending, wire::Op{});
  if (state != ScriptProcess::State::returned) {
    handleLostProcess(script, op, state == ScriptProcess::State::tooLong);
    return XS_STOPPED;
  }
  const XsResult result = process->result();
  script.stopped = script.stopped || process->stopped();
  const XsResult finalResult = leave(script, wire::functionName(op), result);
  const bool goesOn = process->busy(); // continues with initialize
  if (op == wire::Op::create && result == XS_OK && finalResult != XS_OK) {
    process->orphaned = goesOn;
    process->discarded.push_back(script.number);
  } else if (goesOn) {
    enter(script);
    script.pending = wire::Op::initialize;
  }
  return finalResult;
}

// --- When a process ends ---

// Handles a process that one of its functions has ended, or that must be ended with the function.
void ScriptHost::handleLostProcess(Script& script, wire::Op op, bool tooLong) {
  const ProcessRef process = script.process;
  const char* function = wire::functionName(op);
  script.stopped = true;
  script.outputs.clear();
  script.waiting.clear();
  log(script, 3, 1,
      tooLong
          ? fmt::format("{} took too long: the Script is stopped", function)
          : fmt::format("{}: its process {}: the Script is stopped", function, process->death()));
  detach(script);
  processes_->programEnded();
  restartAll(*process);
}

// Detaches a Script from its process.
void ScriptHost::detach(Script& script) {
  script.process->remove();
  script.process.reset();
  script.pending = {};
  script.engine = nullptr;
  script.lent.clear();
  script.handles.clear();
}

void ScriptHost::restartAll(const ScriptProcess& gone) {
  if (closing_) return;
  std::vector<Key> keys;
  for (const auto& [key, script] : scripts_)
    if (script->process.get() == &gone) keys.push_back(key);
  for (const Key key : keys)
    if (const auto found = scripts_.find(key); found != scripts_.end())
      restart(key, *found->second, gone.death());
}

void ScriptHost::restart(Key key, Script& script, const std::string& why) {
  const NodeRef keep(script.node);
  script.outputs.clear();
  std::erase(ticking_, key);
  detach(script);
  if (script.stopped) return;
  if (++script.restarts > maxRestarts) {
    script.stopped = true;
    script.waiting.clear();
    return log(script, 3, 1,
               fmt::format("the process that it runs in {} again: the Script is stopped", why));
  }
  log(script, 2, 1, fmt::format("the process that it runs in {}: it is started anew", why));
  script.nextUrl = 0;
  script.startPending = true;
  startQueue_.push_back(key);
  engine_.requestScriptStart();
}

// --- When a Script ends ---

void ScriptHost::stopRemote(Script& script) {
  const bool ending = std::exchange(ending_, true);
  const bool creating = script.pending == wire::Op::create;
  const bool shutting = script.pending == wire::Op::shutdown; // shutdown was sent early
  if (script.pending != wire::Op{}) waitFor(script);
  const bool overdue = isTimeUsedUp() || (closing_ && wire::Clock::now() >= shutdownDeadline_);
  if (script.process && !script.busy() && !creating && !shutting && !overdue)
    plainCall(script, wire::Op::shutdown, &XsEngine::shutdown);
  ending_ = ending;
  if (!script.process) return;
  const ProcessRef process = script.process;
  const bool running = script.pending != wire::Op{};
  if (running) {
    log(script, 1, 0,
        fmt::format("{} was still running when the Script ended",
                    wire::functionName(script.pending)));
    process->orphaned = true;
  }
  detach(script);
  process->discarded.push_back(script.number);
  if (closing_) return;
  if (process->scripts() == 0 && running)
    processes_->remove(*process);
  else
    discard(process, forEver, patienceEnds());
  if (startQueue_.empty()) processes_->trim();
}

// Sends shutdown early to a few Scripts after `from` when the world ends, each in a process where
// nothing else runs.
void ScriptHost::shutDownEarly(Key from) {
  if (isTimeUsedUp() || wire::Clock::now() >= shutdownDeadline_) return;
  size_t left = ScriptProcesses::most;
  for (auto next = scripts_.upper_bound(from); next != scripts_.end() && left > 0; ++next, --left) {
    Script& script = *next->second;
    if (!script.process || !script.engine || !script.engine->shutdown || script.busy() ||
        script.process->dead())
      continue;
    message_.begin(wire::Op::shutdown, script.number, engine_.now());
    beginCall(script, wire::Op::shutdown, message_);
  }
}

// Destroys unused interpreters when nothing else runs in their process.
void ScriptHost::discard(const ProcessRef& process, double first, wire::Clock::time_point until) {
  for (;;) {
    if (process->busy()) {
      if (!process->orphaned) return; // a Script waits for that call
      const ScriptProcess::State state = runAs(nullptr, [&] {
        return process->serve(first, std::max(first, linger), until, engine_.now());
      });
      if (state == ScriptProcess::State::running) return;
      process->orphaned = false;
      if (state != ScriptProcess::State::returned) return restartAll(*process);
    }
    if (process->dead() || process->discarded.empty()) return;
    message_.begin(wire::Op::destroy, process->discarded.back(), engine_.now());
    process->discarded.pop_back();
    if (!process->begin(message_)) return restartAll(*process);
    process->orphaned = true;
  }
}

// --- With every tick ---

void ScriptHost::serveRunningCalls() {
  const auto end = wire::Clock::now() + tickShare;
  std::vector<Key> keys;
  for (const auto& [key, script] : scripts_)
    if (script->pending != wire::Op{} && !script->startedEarly) keys.push_back(key);
  for (size_t left = keys.size(); left > 0; --left) {
    const Key key = keys[keys.size() - left];
    const auto found = scripts_.find(key);
    if (found == scripts_.end() || found->second->pending == wire::Op{}) continue;
    Script& script = *found->second;
    const wire::Op op = script.pending;
    const auto now = wire::Clock::now();
    const XsResult result = serveCall(
        script, 0, linger, now + std::max(wire::Clock::duration{}, (end - now) / int64_t(left)));
    if (result == later) continue;
    if (op == wire::Op::create && !created(script, result)) start(script);
  }
  for (const ProcessRef& process : std::vector<ProcessRef>(processes_->all()))
    discard(process, 0, end);
  if (startQueue_.empty()) processes_->trim();
  // Scripts that waited for this call, or for others in their process, are due.
  for (const auto& [key, script] : scripts_)
    if (script->process && !script->busy() &&
        (script->eventsProcessedDue || !script->waiting.empty()))
      due_[key] = true;
  const auto idle = [](const ProcessRef& process) { return !process->busy(); };
  if (waitingForProcess_.empty() ||
      std::none_of(processes_->all().begin(), processes_->all().end(), idle))
    return;
  for (const Key key : std::exchange(waitingForProcess_, {})) startQueue_.push_back(key);
  engine_.requestScriptStart();
}

} // namespace xvrml
