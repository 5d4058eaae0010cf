// engine.cpp: the plug-in: Tcl as a script engine. See docs/scripts.md "Tcl/Tk". [the browser's
// thread]
#include <clocale>
#include <csignal>
#include <new>
#include <string>

#include <dlfcn.h>
#include <unistd.h>

#include "interpreter.h"
#include "notifier.h"

namespace {

using tclscript::Interpreter;

Interpreter& of(XsInterpreter interpreter) {
  return *reinterpret_cast<Interpreter*>(uintptr_t(interpreter));
}

// Nothing is thrown across the border.
template <class Body> XsResult guarded(Body&& body) {
  try {
    return body();
  } catch (const std::exception&) { return XS_FAILED; }
}

// Tcl begins: it takes a signal and the locale for its own, which are the host's.
void begin() {
  struct sigaction pipe {};
  sigaction(SIGPIPE, nullptr, &pipe);
  const char* current = std::setlocale(LC_ALL, nullptr);
  const std::string locale = current ? current : "C";
  // A program with Tk windows of its own, as Python's tkinter makes them, has begun to use Tcl: it
  // goes on as it began.
  if (void* tk = dlopen("libtk" TCL_VERSION ".so", RTLD_LAZY | RTLD_NOLOAD))
    dlclose(tk);
  else
    tclscript::setNotifier();
  Tcl_FindExecutable(nullptr); // finds nothing, so that no program can ask where the host is
  Tcl_Interp* first = Tcl_CreateInterp(); // tables that the first one makes
  Tcl_Eval(first, "expr {1 + 1.5}; string is alpha x; regexp {a+} aa; clock seconds; lsort {b a}");
  Tcl_DeleteInterp(first);
  sigaction(SIGPIPE, &pipe, nullptr);
  std::setlocale(LC_ALL, locale.c_str());
}

XsResult prepare() {
  static const bool begun = (begin(), true);
  (void)begun;
  return XS_OK;
}

XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  return guarded([&] {
    prepare();
    static char* none[] = {nullptr};
    if (!environ) environ = none; // after clearenv; Tcl looks at the first
    auto interpreter = std::make_unique<Interpreter>(host, info);
    const XsResult result = interpreter->create();
    if (result == XS_OK) *made = XsInterpreter(reinterpret_cast<uintptr_t>(interpreter.release()));
    return result;
  });
}

void destroy(XsInterpreter interpreter) { delete &of(interpreter); }

XsResult call(XsInterpreter interpreter, const char* procedure, double time) {
  return guarded([&] {
    return of(interpreter).callProcedure(procedure, {tclscript::Object(Tcl_NewDoubleObj(time))});
  });
}
XsResult initialize(XsInterpreter interpreter, double time) {
  return call(interpreter, "initialize", time);
}
XsResult eventsProcessed(XsInterpreter interpreter, double time) {
  return call(interpreter, "eventsProcessed", time);
}
XsResult shutdown(XsInterpreter interpreter, double time) {
  const XsResult result = call(interpreter, "shutdown", time);
  return result == XS_STOPPED ? XS_OK : result; // it has been told of before
}
XsResult event(XsInterpreter interpreter, const XsEvent* event) {
  return guarded([&] { return of(interpreter).event(*event); });
}
XsResult tick(XsInterpreter interpreter, double time) {
  return guarded([&] { return of(interpreter).tick(time); });
}

const char* const schemes[] = {"tcl", nullptr};
const char* const mimeTypes[] = {"application/x-tcl", "text/x-tcl", nullptr};
const char* const suffixes[] = {".tcl", ".tk", nullptr};
const XsEngine engine = {.size = sizeof(XsEngine),
                         .flags = 0,
                         .name = "tcl",
                         .text = "Tcl " TCL_PATCH_LEVEL ", with Tk in trusted worlds",
                         .schemes = schemes,
                         .mimeTypes = mimeTypes,
                         .suffixes = suffixes,
                         .create = create,
                         .destroy = destroy,
                         .initialize = initialize,
                         .event = event,
                         .eventsProcessed = eventsProcessed,
                         .shutdown = shutdown,
                         .tick = tick,
                         .prepare = prepare};
const XsEngine* const engines[] = {&engine};

} // namespace

extern "C" {
XS_EXPORT extern const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin),
                                            1,        engines};
}
