// native.cpp: Implements the script engine `native`, which calls C functions of shared libraries
// with VRML's values (docs/scripts.md, "Native functions"). The effects of such functions cannot be
// limited, so only trusted worlds may use them. [the browser's thread]
#include <algorithm>
#include <memory>
#include <new>
#include <set>
#include <utility>

#include <dlfcn.h>

#include "call.h"
#include "library.h"
#include "system/libraries.h"

using namespace native;

namespace {

class Interpreter {
 public:
  Interpreter(const XsHost* host, const XsScriptInfo* info)
      : host_(host), info_(*info), inputs_(info->fieldCount) {
    for (uint32_t i = 0; i < info_.fieldCount; ++i) inputs_[i] = Slot(info_.fields[i].type);
  }
  ~Interpreter() {
    for (uint32_t i = 0; i < info_.fieldCount; ++i) releaseNodes(i);
  }
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  XsResult load() {
    uint32_t line = 1;
    try {
      const std::string_view text(info_.text.data, info_.text.bytes);
      void* library = loadLibrary(libraryName(text));
      const Program program = readProgram(
          text, info_,
          [&](const std::string& name) { return dlsym(library, name.c_str()) != nullptr; },
          [&](const std::string& name) { return isOwn(library, name); });
      for (const Call& call : program.calls) {
        line = call.line;
        calls_.push_back(
            std::make_unique<PreparedCall>(call, dlsym(library, call.function.c_str()), info_));
      }
      warnUnused(program);
      return XS_OK;
    } catch (const ProgramError& error) {
      log(3, error.line, error.what());
    } catch (const std::exception& error) { log(3, line, error.what()); }
    return XS_FAILED;
  }

  XsResult event(const XsEvent& event) {
    releaseNodes(event.index);
    inputs_[event.index].copy(event.value);
    if (elementType(event.value.type) == XS_SFNODE &&
        info_.fields[event.index].access == XS_EVENT_IN)
      for (uint32_t i = 0; i < event.value.count; ++i)
        host_->retain(host_, info_.self, event.value.of.nodes[i]);
    arrived_ = true;
    return run(event.time, [&](const Call& call) {
      return call.when == Call::When::event && call.event == event.index;
    });
  }
  // Calls the functions with several inputs after all inputs have arrived.
  XsResult eventsProcessed(double time) {
    if (!std::exchange(arrived_, false)) return XS_OK;
    return run(time, [](const Call& call) { return call.when == Call::When::events; });
  }
  XsResult at(Call::When when, double time) {
    return run(time, [when](const Call& call) { return call.when == when; });
  }

 private:
  // Returns whether the library itself defines a function; the C library has poll and shutdown.
  static bool isOwn(void* library, const std::string& name) {
    return os::defines(library, dlsym(library, name.c_str()));
  }

  template <class Wanted> XsResult run(double time, Wanted&& wanted) {
    XsResult answer = XS_OK;
    try {
      const PreparedCall::World world{
          host_,
          info_.self,
          time,
          [this](uint32_t field) -> Slot& { return input(field); },
          [this](uint32_t field, const XsValue& value) { return give(field, value); },
          [this](int32_t severity, uint32_t line, const std::string& what) {
            log(severity, line, what);
          }};
      for (const auto& call : calls_)
        if (wanted(call->call()) && answer == XS_OK) answer = call->run(world);
    } catch (const std::exception& error) {
      log(3, 0, error.what());
      return XS_FAILED;
    }
    return host_->shouldStop(host_, info_.self, 1) ? XS_STOPPED : answer;
  }

  Slot& input(uint32_t field) {
    XsValue value;
    const XsAccess access = info_.fields[field].access;
    const bool own = access == XS_FIELD || access == XS_EXPOSED_FIELD;
    if (own &&
        host_->read(host_, info_.self, info_.self, info_.fields[field].name, &value) == XS_OK)
      inputs_[field].copy(value);
    return inputs_[field];
  }
  XsResult give(uint32_t field, const XsValue& value) {
    const XsField& to = info_.fields[field];
    return (to.access == XS_EVENT_OUT ? host_->send : host_->write)(host_, info_.self, to.name,
                                                                    &value);
  }
  // Releases the nodes of an eventIn's value; they are retained because a later call may use them.
  void releaseNodes(uint32_t field) {
    if (info_.fields[field].access != XS_EVENT_IN ||
        elementType(inputs_[field].type()) != XS_SFNODE)
      return;
    const auto* nodes = static_cast<const XsNode*>(inputs_[field].data());
    for (uint32_t i = 0; i < inputs_[field].count(); ++i)
      if (nodes[i]) host_->release(host_, info_.self, nodes[i]);
  }
  void log(int32_t severity, uint32_t line, const std::string& what) const {
    host_->log(host_, info_.self, severity, line, {what.data(), what.size()});
  }

  // Warns about events that no function uses; they are probably mistakes.
  void warnUnused(const Program& program) const {
    std::set<uint32_t> used;
    for (const Call& call : program.calls) {
      if (call.result) used.insert(call.target.field);
      if (call.when == Call::When::event) used.insert(call.event);
      bool host = false;
      for (const Argument& argument : call.arguments) {
        host = host || argument.kind == Argument::Kind::host;
        if (argument.kind == Argument::Kind::field) used.insert(argument.field);
      }
      if (host) return; // the function gets the host and may use any event
    }
    for (uint32_t i = 0; i < info_.fieldCount; ++i)
      if (info_.fields[i].access != XS_FIELD && info_.fields[i].access != XS_EXPOSED_FIELD &&
          !used.contains(i))
        log(2, 0,
            std::string("native: no function ") +
                (info_.fields[i].access == XS_EVENT_IN ? "takes " : "gives ") +
                info_.fields[i].name);
  }

  const XsHost* host_;
  const XsScriptInfo& info_;
  std::vector<Slot> inputs_; // values of fields and eventIns
  std::vector<std::unique_ptr<PreparedCall>> calls_;
  bool arrived_ = false;
};

Interpreter& of(XsInterpreter interpreter) {
  return *reinterpret_cast<Interpreter*>(uintptr_t(interpreter));
}

XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  try {
    auto interpreter = std::make_unique<Interpreter>(host, info);
    const XsResult answer = interpreter->load();
    if (answer == XS_OK) *made = XsInterpreter(reinterpret_cast<uintptr_t>(interpreter.release()));
    return answer;
  } catch (const std::bad_alloc&) { return XS_FAILED; }
}
void destroy(XsInterpreter interpreter) { delete &of(interpreter); }
XsResult initialize(XsInterpreter i, double time) { return of(i).at(Call::When::initialize, time); }
XsResult event(XsInterpreter i, const XsEvent* event) { return of(i).event(*event); }
XsResult eventsProcessed(XsInterpreter i, double time) { return of(i).eventsProcessed(time); }
XsResult shutdown(XsInterpreter i, double time) { return of(i).at(Call::When::shutdown, time); }
XsResult tick(XsInterpreter i, double time) { return of(i).at(Call::When::poll, time); }

const char* const schemes[] = {"native", nullptr};
const XsEngine engine = {
    sizeof(XsEngine), XS_NEEDS_TRUST, "native", "C functions of shared libraries, through libffi",
    schemes,          nullptr,        nullptr,  create,
    destroy,          initialize,     event,    eventsProcessed,
    shutdown,         tick,           nullptr,  nullptr};
const XsEngine* const engines[] = {&engine};

} // namespace

extern "C" {
XS_EXPORT extern const XsPlugin xsPlugin;
const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin), 1, engines};
}
