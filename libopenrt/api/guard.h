// guard.h: the entry from C into the library. Every API function runs inside guarded(), which finds
// the current context and catches all exceptions.
#pragma once

#include <utility>

#include "api/context.h"

namespace openrt {

void reportNoContext(const char* function) noexcept;

// Runs body(context) and returns its result. If it throws, or if no context is current, records the
// error and returns `failure`.
template <class Result, class Body>
Result guarded(const char* function, Result failure, Body&& body) noexcept {
  Context* const context = currentContext;
  if (!context || !context->open()) [[unlikely]] {
    reportNoContext(function);
    return failure;
  }
  try {
    return body(*context);
  } catch (...) { recordCurrentException(context->errors, function); }
  return failure;
}

template <class Body> void guarded(const char* function, Body&& body) noexcept {
  Context* const context = currentContext;
  if (!context || !context->open()) [[unlikely]] {
    reportNoContext(function);
    return;
  }
  try {
    body(*context);
  } catch (...) { recordCurrentException(context->errors, function); }
}

} // namespace openrt
