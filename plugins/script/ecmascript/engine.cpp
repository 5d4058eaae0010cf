// engine.cpp: Defines the plug-in with the engine "ecmascript" for javascript:, vrmlscript:,
// ecmascript: and .js files (ISO/IEC 14772-1 Annex C), on QuickJS or Duktape. See docs/scripts.md.
// [the browser's thread]
#include <ctime>

#include "interpreter.h"

namespace {

using ecma::Interpreter;

Interpreter& of(XsInterpreter interpreter) {
  return *reinterpret_cast<Interpreter*>(uintptr_t(interpreter));
}

constexpr const char* prepareEvents = "prepareEvents";

XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  XsResult result = XS_FAILED;
  *made = reinterpret_cast<uintptr_t>(ecma::createInterpreter(host, info, result));
  return result;
}
void destroy(XsInterpreter interpreter) { ecma::destroyInterpreter(&of(interpreter)); }
XsResult initialize(XsInterpreter interpreter, double time) {
  return callFunction(of(interpreter), "initialize", nullptr, time);
}
XsResult event(XsInterpreter interpreter, const XsEvent* event) {
  return receiveEvent(of(interpreter), *event);
}
XsResult eventsProcessed(XsInterpreter interpreter, double time) {
  return callFunction(of(interpreter), "eventsProcessed", nullptr, time);
}
// Lets a program of X3D collect what has arrived since the last frame (ISO/IEC 19775-1 29.2.5).
XsResult tick(XsInterpreter interpreter, double time) {
  return callFunction(of(interpreter), prepareEvents, nullptr, time);
}
XsResult shutdown(XsInterpreter interpreter, double time) {
  return callFunction(of(interpreter), "shutdown", nullptr, time, true);
}

// Loads the time zone for Date, because the sandbox cannot open files later.
XsResult prepare() {
  tzset();
  return XS_OK;
}

const char* const schemes[] = {"javascript", "vrmlscript", "ecmascript", nullptr};
// RFC 9239 lists the types in use; C.3.3 requires application/x-javascript.
const char* const mimeTypes[] = {
    "application/javascript",   "application/x-javascript", "text/javascript", "text/x-javascript",
    "application/ecmascript",   "application/x-ecmascript", "text/ecmascript", "text/x-ecmascript",
    "application/x-vrmlscript", "application/vrmlscript",   "text/vrmlscript", nullptr};
const char* const suffixes[] = {".js", ".vs", nullptr};
const XsEngine engine = {sizeof(XsEngine), 0,          "ecmascript", ecma::engineText,
                         schemes,          mimeTypes,  suffixes,     create,
                         destroy,          initialize, event,        eventsProcessed,
                         shutdown,         tick,       prepare,      prepareEvents};
const XsEngine* const engines[] = {&engine};

} // namespace

extern "C" XS_EXPORT const XsPlugin xsPlugin = {
    XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin), 1, engines};
