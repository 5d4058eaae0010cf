// errors.cpp: Reports errors of a program with line and function.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "slots.h"

namespace ecma {

void logText(Interpreter& self, int severity, uint32_t line, const char* text, size_t bytes) {
  const XsString message{text, bytes};
  self.host->log(self.host, self.self, severity, line, message);
}

namespace {

struct Spot {
  uint32_t line = 0;
  char function[80] = "";
};

// Finds the first line of the trace that is in the program's own file: "at NAME (script:LINE...)"
// or, for a syntax error of QuickJS, "at script:LINE...".
Spot spotIn(const char* trace) {
  Spot found;
  const char *const end = std::strstr(trace, " (script:"), *name = end;
  const char* const place = end ? end : std::strstr(trace, "at script:");
  if (!place) return found;
  found.line = uint32_t(std::strtoul(std::strchr(place, ':') + 1, nullptr, 10));
  if (!end) return found;
  while (name > trace && name[-1] != ' ') --name;
  const auto length = size_t(end - name);
  const bool named = *name != '[' && *name != '<' && std::strncmp(name, "global ", 7) != 0;
  if (length < sizeof found.function && named) std::memcpy(found.function, name, length);
  return found;
}

} // namespace

void reportError(Interpreter& self, const char* during) {
  duk_context* ctx = self.ctx;
  const duk_idx_t error = duk_get_top_index(ctx);
  Spot spot;
  spot.line = explainSyntax(ctx, self);
  if (duk_is_error(ctx, error)) {
    duk_get_prop_string(ctx, error, "stack");
    if (duk_is_string(ctx, -1)) spot = spotIn(duk_get_string(ctx, -1));
    duk_pop(ctx);
  }
  duk_dup(ctx, error);
  // Duktape says "error in error handling" where not even the error about memory found any.
  const char* given = duk_safe_to_string(ctx, -1);
  if (std::strncmp(given, "DoubleError", 11) == 0) {
    duk_push_string(ctx, "DoubleError: alloc failed, also for the error about it");
    duk_replace(ctx, -2);
  }
  const bool called = std::strcmp(during, "running the program") != 0;
  duk_push_string(ctx, *spot.function || called ? " (in " : "");
  duk_push_string(ctx, *spot.function ? spot.function : called ? during : "");
  duk_push_string(ctx, *spot.function || called ? ")" : "");
  duk_concat(ctx, 4);
  const XsString text = textForHost(ctx, self, -1);
  logText(self, 3, spot.line, text.data, text.bytes);
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
