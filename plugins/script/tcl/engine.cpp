// engine.cpp: Defines the plug-in with Tcl as a script engine. See docs/scripts.md "Tcl/Tk". [the
// browser's thread]
#include <clocale>
#include <csignal>
#include <new>
#include <string>

#include <dlfcn.h>
#include <unistd.h>

#include "interpreter.h"
#include "notifier.h"
#include "system/process.h"

namespace {

using tclscript::Interpreter;

Interpreter& of(XsInterpreter interpreter) {
  return *reinterpret_cast<Interpreter*>(uintptr_t(interpreter));
}

// Catches all exceptions: none may cross the plug-in interface.
template <class Body> XsResult guarded(Body&& body) {
  try {
    return body();
  } catch (const std::exception&) { return XS_FAILED; }
}

// Initializes Tcl, which changes a signal handler and the locale; restores both, because the host
// owns them.
void begin() {
  struct sigaction pipe {};
  sigaction(SIGPIPE, nullptr, &pipe);
  const char* current = std::setlocale(LC_ALL, nullptr);
  const std::string locale = current ? current : "C";
  // If the program has Tk windows of its own (for example Python's tkinter), Tcl has already been
  // initialized and keeps its notifier.
  if (void* tk = dlopen("libtk" TCL_VERSION ".so", RTLD_LAZY | RTLD_NOLOAD))
    dlclose(tk);
  else
    tclscript::setNotifier();
  // deliberately finds nothing, so that no program can ask for the host's path
  Tcl_FindExecutable(nullptr);
  Tcl_Interp* first = Tcl_CreateInterp(); // the first interpreter creates shared tables
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
    os::listEnvironment(); // Tcl reads the first entry
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
  return result == XS_STOPPED ? XS_OK : result; // the host has already reported it
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
                         .prepare = prepare,
                         .tickWord = nullptr};
const XsEngine* const engines[] = {&engine};

} // namespace

extern "C" {
XS_EXPORT extern const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin),
                                            1,        engines};
}
