// errors.cpp: Reports errors of a program with line and function.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <new>

#include "newer.h"
#include "slots.h"

namespace ecma {

void logText(Interpreter& self, int severity, uint32_t line, const char* text, size_t bytes) {
  const XsString message{text, bytes};
  self.host->log(self.host, self.self, severity, line, message);
}

namespace {

// Replaces a syntax error on top of the stack by one that names what the engine cannot know.
// Returns its line; 0 if the program has nothing newer.
uint32_t explainSyntax(duk_context* ctx, const Interpreter& self) {
  if (duk_get_error_code(ctx, -1) != DUK_ERR_SYNTAX_ERROR) return 0;
  NewerSyntax newer;
  try {
    newer = findNewer({self.info->text.data, self.info->text.bytes});
  } catch (const std::bad_alloc&) {} // the engine's own words have to do
  if (newer.line == 0) return 0;
  duk_push_sprintf(ctx, "SyntaxError: '%s' is newer than ECMAScript 5.1, which this engine runs",
                   newer.what);
  duk_replace(ctx, -2);
  return newer.line;
}

} // namespace

// Duktape's trace has a line "at NAME (FILE:LINE) ..." for each function. The first one in the
// program's own file is reported.
void reportError(Interpreter& self, const char* during) {
  duk_context* ctx = self.ctx;
  const duk_idx_t error = duk_get_top_index(ctx);
  uint32_t line = explainSyntax(ctx, self);
  char function[80] = "";
  if (duk_is_error(ctx, error)) {
    duk_get_prop_string(ctx, error, "stack");
    const char* stack = duk_is_string(ctx, -1) ? duk_get_string(ctx, -1) : "";
    const char* place = std::strstr(stack, " (script:");
    if (place) {
      line = uint32_t(std::strtoul(place + 9, nullptr, 10));
      const char* name = place;
      while (name > stack && name[-1] != ' ') --name;
      const auto length = size_t(place - name);
      if (length < sizeof function && *name != '[' && std::strncmp(name, "global ", 7) != 0)
        std::memcpy(function, name, length);
    }
    duk_pop(ctx);
  }
  duk_dup(ctx, error);
  // Duktape says "error in error handling" where not even the error about memory found any.
  const char* given = duk_safe_to_string(ctx, -1);
  if (std::strncmp(given, "DoubleError", 11) == 0) {
    duk_push_string(ctx, "DoubleError: alloc failed, also for the error about it");
    duk_replace(ctx, -2);
  }
  duk_push_string(ctx, *function || std::strcmp(during, "running the program") != 0 ? " (in " : "");
  duk_push_string(ctx, *function                                         ? function
                       : std::strcmp(during, "running the program") != 0 ? during
                                                                         : "");
  duk_push_string(ctx, *function || std::strcmp(during, "running the program") != 0 ? ")" : "");
  duk_concat(ctx, 4);
  const XsString text = textForHost(ctx, self, -1);
  logText(self, 3, line, text.data, text.bytes);
}

void throwType(duk_context* ctx, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  duk_error_va(ctx, DUK_ERR_TYPE_ERROR, format, arguments);
  va_end(arguments);
  __builtin_unreachable(); // duk_throw does not return
}

void throwRange(duk_context* ctx, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  duk_error_va(ctx, DUK_ERR_RANGE_ERROR, format, arguments);
  va_end(arguments);
  __builtin_unreachable(); // duk_throw does not return
}

void throwHost(duk_context* ctx, Interpreter& self, XsResult result, const char* what) {
  if (result == XS_STOPPED) {
    self.stopped = true;
    throwRange(ctx, "the Script is stopped");
  }
  XsString why{"", 0};
  self.host->lastError(self.host, self.self, &why);
  duk_push_lstring(ctx, why.data, why.bytes);
  throwType(ctx, "%s: %s", what, duk_get_string(ctx, -1));
}

} // namespace ecma
