// jobs.cpp: Runs the jobs of promises after each call of the host, so that `await` goes on within
// the call that has resolved its promise.
#include "stack.h"

namespace ecma {
namespace {

constexpr uint32_t mostRejected = 64; // further rejections are not reported

// Notes promises that are rejected, in pairs with the reasons, and forgets them when a handler
// comes.
void onRejection(JSContext* js, JSValueConst promise, JSValueConst reason, int handled, void* of) {
  const auto* s = static_cast<const ScriptStack*>(of);
  for (uint32_t i = 0; i < 2 * mostRejected; i += 2) {
    const JSValue known = JS_GetPropertyUint32(js, s->rejected, i);
    const bool free = JS_IsUndefined(known);
    const bool same = JS_IsObject(known) && JS_VALUE_GET_PTR(known) == JS_VALUE_GET_PTR(promise);
    JS_FreeValue(js, known);
    if (handled ? !same : !free) continue;
    const JSValueConst kept = handled ? JS_NULL : promise;
    if (JS_DefinePropertyValueUint32(js, s->rejected, i, JS_DupValue(js, kept), JS_PROP_C_W_E) <
            0 ||
        JS_DefinePropertyValueUint32(
            js, s->rejected, i + 1, JS_DupValue(js, handled ? JS_NULL : reason), JS_PROP_C_W_E) < 0)
      JS_FreeValue(js, JS_GetException(js)); // no memory to note it
    return;
  }
}

// Takes the first rejection that has no handler, and forgets all others.
bool takeRejection(ScriptStack* s, JSValue& reason) {
  bool found = false;
  for (uint32_t i = 0; i < 2 * mostRejected && !found; i += 2) {
    const JSValue promise = JS_GetPropertyUint32(s->js, s->rejected, i);
    found = JS_IsObject(promise);
    if (found) reason = JS_GetPropertyUint32(s->js, s->rejected, i + 1);
    const bool end = JS_IsUndefined(promise);
    JS_FreeValue(s->js, promise);
    if (end) break;
  }
  if (JS_SetPropertyStr(s->js, s->rejected, "length", JS_NewInt32(s->js, 0)) < 0)
    JS_FreeValue(s->js, JS_GetException(s->js));
  return found;
}

} // namespace

void watchJobs(ScriptStack* s) { JS_SetHostPromiseRejectionTracker(s->runtime, onRejection, s); }

bool runJobs(ScriptStack* s, JSValue& error) {
  JSContext* js = nullptr;
  int state = 0;
  // a job that is interrupted only rejects its promise
  do state = JS_ExecutePendingJob(s->runtime, &js);
  while (state > 0 && !s->stopped);
  if (state < 0) error = JS_GetException(s->js);
  return state < 0 || takeRejection(s, error);
}

} // namespace ecma
