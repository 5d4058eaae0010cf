// python.cpp: Defines the script engine `python` for Python in trusted worlds (docs/scripts.md,
// "Python"). Its programs can do everything that the user can. [the browser's thread]
#include <new>

#include "interpreter.h"

using namespace python;

namespace {

Interpreter& of(XsInterpreter interpreter) {
  return *reinterpret_cast<Interpreter*>(uintptr_t(interpreter));
}

XsResult create(const XsHost* host, const XsScriptInfo* info, XsInterpreter* made) {
  try {
    startPython();
    const Gil gil;
    auto interpreter = std::make_unique<Interpreter>(host, info);
    const XsResult result = interpreter->load();
    if (result == XS_OK) *made = XsInterpreter(reinterpret_cast<uintptr_t>(interpreter.release()));
    return result;
  } catch (const std::exception& error) {
    const std::string why = error.what();
    host->log(host, info->self, 3, 0, {why.data(), why.size()});
    return XS_FAILED;
  }
}

// Runs code with the GIL. A Python program may end its interpreter before its browsers; then this
// fails.
template <class Work> XsResult with(XsInterpreter interpreter, Work&& work) {
  if (!Py_IsInitialized()) return XS_FAILED;
  try {
    const Gil gil;
    return work(of(interpreter));
  } catch (const std::exception&) { return XS_FAILED; } // there is no memory for a message
}

void destroy(XsInterpreter interpreter) {
  if (!Py_IsInitialized()) return;
  const Gil gil;
  delete &of(interpreter);
}
XsResult initialize(XsInterpreter i, double) {
  return with(i, [](Interpreter& self) { return self.call("initialize"); });
}
XsResult event(XsInterpreter i, const XsEvent* event) {
  return with(i, [&](Interpreter& self) { return self.event(*event); });
}
XsResult eventsProcessed(XsInterpreter i, double) {
  return with(i, [](Interpreter& self) { return self.call("eventsProcessed"); });
}
XsResult shutdown(XsInterpreter i, double) {
  return with(i, [](Interpreter& self) { return self.call("shutdown"); });
}

const char* const schemes[] = {"python", nullptr};
const char* const mimeTypes[] = {"text/x-python", "application/x-python-code", nullptr};
const char* const suffixes[] = {".py", nullptr};
const XsEngine engine = {sizeof(XsEngine), XS_NEEDS_TRUST, "python", "Python " PY_VERSION,
                         schemes,          mimeTypes,      suffixes, create,
                         destroy,          initialize,     event,    eventsProcessed,
                         shutdown,         nullptr,        nullptr,  nullptr};
const XsEngine* const engines[] = {&engine};

} // namespace

extern "C" {
XS_EXPORT extern const XsPlugin xsPlugin;
const XsPlugin xsPlugin = {XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin), 1, engines};
}
