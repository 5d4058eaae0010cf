// calls.cpp: Implements native functions, protected calls, programs and errors.
#include <cstdio>

#include "stack.h"

using namespace ecma;

namespace ecma {

void fail(ScriptStack* s) {
  if (s->frame == &s->bottom) s->fatal(s->memory.udata, "an error outside of any call");
  std::longjmp(s->frame->target, 1);
}

void failMemory(ScriptStack* s) {
  JS_ThrowOutOfMemory(s->js);
  fail(s);
}

int runProtected(ScriptStack* s, Frame& frame, Work work, void* data) {
  if (setjmp(frame.target)) return -1;
  return work(s, data);
}

void enterFrame(ScriptStack* s, Frame& frame, JSValueConst self, int magic) {
  frame.outer = s->frame;
  frame.base = s->top;
  frame.texts = s->textCount;
  frame.self = self;
  frame.magic = magic;
  frame.finalizes = false;
  s->frame = &frame;
}

void leaveFrame(ScriptStack* s, const Frame& frame, size_t top) {
  truncate(s, top);
  freeTexts(s, frame.texts);
  s->frame = frame.outer;
}

namespace {

// Returns the address of the caller's frame; the stack grows downwards.
inline uintptr_t stackNow() { return reinterpret_cast<uintptr_t>(__builtin_frame_address(0)); }

struct Invocation {
  Native native;
  int count;
  JSValueConst* arguments;
};

int runNative(ScriptStack* s, void* data) {
  const Invocation& call = *static_cast<const Invocation*>(data);
  const int wanted = call.native.arguments == DUK_VARARGS ? call.count : call.native.arguments;
  for (int i = 0; i < wanted; ++i)
    push(s, i < call.count ? JS_DupValue(s->js, call.arguments[i]) : JS_UNDEFINED);
  return call.native.function(s);
}

// Returns what `new` gives: the object that the function has returned, else a new one. A class of
// the program that extends the function gets its own prototype.
JSValue constructed(ScriptStack* s, JSValueConst function, JSValueConst target, JSValue result) {
  const bool derived = JS_VALUE_GET_PTR(function) != JS_VALUE_GET_PTR(target);
  if (JS_IsException(result) || (JS_IsObject(result) && !derived)) return result;
  const JSValue prototype = JS_GetPropertyStr(s->js, target, "prototype");
  if (JS_IsException(prototype) || !JS_IsObject(result)) {
    JS_FreeValue(s->js, result);
    result = JS_IsException(prototype) ? prototype : JS_NewObjectProto(s->js, prototype);
  } else if (JS_IsObject(prototype) && derive(s, result, prototype) < 0) {
    JS_FreeValue(s->js, result);
    result = JS_EXCEPTION;
  }
  JS_FreeValue(s->js, prototype);
  return result;
}

JSValue callNative(JSContext* js, JSValueConst function, JSValueConst self, int count,
                   JSValueConst* arguments, int flags) {
  auto* s = static_cast<ScriptStack*>(JS_GetContextOpaque(js));
  const bool constructs = flags & JS_CALL_FLAG_CONSTRUCTOR;
  // QuickJS looks at the stack only in functions of programs, and proxies may call each other
  if (s->stackTop - stackNow() > stackBytes) return JS_ThrowInternalError(js, "stack overflow");
  Invocation call{*nativeAt(s, function), count, arguments};
  Frame frame;
  enterFrame(s, frame, constructs ? JS_UNDEFINED : self, call.native.magic);
  const int results = runProtected(s, frame, runNative, &call);
  JSValue result = JS_EXCEPTION;
  if (results >= 0) result = results > 0 ? takeTop(s).value : JS_UNDEFINED;
  leaveFrame(s, frame, frame.base);
  return constructs ? constructed(s, function, self, result) : result;
}

void finalizeFunction(JSRuntime* runtime, JSValue function) {
  const auto* s = static_cast<const ScriptStack*>(JS_GetRuntimeOpaque(runtime));
  js_free_rt(runtime, JS_GetOpaque(function, s->functionClass));
}

const JSClassDef functionClass = {"Function", finalizeFunction, nullptr, callNative, nullptr};

// Calls with the values on top, and replaces `drop` values by the result.
void call(ScriptStack* s, JSValueConst function, JSValueConst self, duk_idx_t count,
          duk_idx_t drop) {
  constexpr int most = 8;
  JSValue arguments[most];
  if (count > most) {
    JS_ThrowRangeError(s->js, "more than %d arguments", most);
    fail(s);
  }
  for (int i = 0; i < count; ++i) arguments[i] = valueAt(s, i - count);
  const JSValue result = JS_Call(s->js, function, self, count, arguments);
  if (JS_IsException(result)) fail(s);
  duk_pop_n(s, drop);
  push(s, result);
}

// Replaces the text and the file name on top by the program, as a value that duk_call() runs.
int compile(ScriptStack* s, void*) {
  size_t bytes = 0;
  const char* text = textOf(s, valueAt(s, -2), &bytes);
  const JSValue program = JS_Eval(s->js, text, bytes, textOf(s, valueAt(s, -1), nullptr),
                                  JS_EVAL_TYPE_GLOBAL | JS_EVAL_FLAG_COMPILE_ONLY);
  if (JS_IsException(program)) fail(s);
  duk_pop_2(s);
  push(s, program);
  return 0;
}

struct SafeCall {
  duk_safe_call_function function;
  void* udata;
};
int runSafeCall(ScriptStack* s, void* data) {
  const SafeCall& call = *static_cast<const SafeCall*>(data);
  return call.function(s, call.udata);
}

// Enters a frame that sees the values of the one outside it.
void enterInside(ScriptStack* s, Frame& frame) {
  const Frame& outer = *s->frame;
  enterFrame(s, frame, outer.self, outer.magic);
  frame.base = outer.base;
}

} // namespace

const Native* nativeAt(const ScriptStack* s, JSValueConst function) {
  return static_cast<const Native*>(JS_GetOpaque(function, s->functionClass));
}

int registerFunctions(ScriptStack* s) {
  static const JSClassID functions = [] {
    JSClassID id = 0;
    return JS_NewClassID(&id);
  }();
  s->functionClass = functions;
  return JS_NewClass(s->runtime, functions, &functionClass);
}

} // namespace ecma

void duk_push_c_function(duk_context* ctx, duk_c_function function, duk_idx_t arguments) {
  push(ctx, JS_NewObjectProtoClass(ctx->js, ctx->functionPrototype, ctx->functionClass));
  auto* native = static_cast<Native*>(js_malloc(ctx->js, sizeof(Native)));
  if (!native) fail(ctx);
  *native = {function, int16_t(arguments), 0};
  JS_SetOpaque(valueAt(ctx, -1), native);
  JS_SetConstructorBit(ctx->js, valueAt(ctx, -1), true);
  if (arguments <= 0) return;
  check(ctx, JS_DefinePropertyValueStr(ctx->js, valueAt(ctx, -1), "length",
                                       JS_NewInt32(ctx->js, arguments), JS_PROP_CONFIGURABLE));
}

void duk_set_magic(duk_context* ctx, duk_idx_t function, int magic) {
  auto* native = static_cast<Native*>(JS_GetOpaque(valueAt(ctx, function), ctx->functionClass));
  native->magic = int16_t(magic);
}

int duk_get_current_magic(duk_context* ctx) { return ctx->frame->magic; }
void duk_push_this(duk_context* ctx) { push(ctx, JS_DupValue(ctx->js, ctx->frame->self)); }

void duk_call(duk_context* ctx, duk_idx_t arguments) {
  const JSValueConst function = valueAt(ctx, -arguments - 1);
  if (JS_VALUE_GET_TAG(function) != JS_TAG_FUNCTION_BYTECODE)
    return call(ctx, function, JS_UNDEFINED, arguments, arguments + 1);
  const JSValue result = JS_EvalFunction(ctx->js, takeTop(ctx).value); // takes the program over
  push(ctx, result);
}

void duk_call_prop(duk_context* ctx, duk_idx_t object, duk_idx_t arguments) {
  object = duk_normalize_index(ctx, object);
  duk_dup(ctx, -arguments - 1);
  duk_get_prop(ctx, object);
  duk_replace(ctx, -arguments - 2);
  call(ctx, valueAt(ctx, -arguments - 1), valueAt(ctx, object), arguments, arguments + 1);
}

int duk_safe_call(duk_context* ctx, duk_safe_call_function function, void* udata,
                  duk_idx_t arguments, duk_idx_t results) {
  const bool outermost = ctx->frame == &ctx->bottom;
  if (outermost) {
    JS_UpdateStackTop(ctx->runtime);
    ctx->stackTop = stackNow();
  }
  const size_t level = ctx->top - size_t(arguments);
  SafeCall safe{function, udata};
  Frame frame;
  enterInside(ctx, frame);
  const int count = runProtected(ctx, frame, runSafeCall, &safe);
  JSValue result = JS_UNDEFINED;
  if (count > 0) result = takeTop(ctx).value;
  if (count < 0) result = JS_GetException(ctx->js);
  leaveFrame(ctx, frame, level < ctx->top ? level : ctx->top);
  JSValue error = JS_UNDEFINED;
  const bool failed = outermost && runJobs(ctx, error);
  JS_FreeValue(ctx->js, count < 0 || !failed ? error : result);
  if (count >= 0 && failed) result = error;
  for (duk_idx_t i = 0; i < results; ++i) {
    push(ctx, result);
    result = JS_UNDEFINED;
  }
  JS_FreeValue(ctx->js, result);
  return count < 0 || failed ? DUK_EXEC_ERROR : DUK_EXEC_SUCCESS;
}

void duk_compile(duk_context* ctx, unsigned /*flags*/) { compile(ctx, nullptr); }

int duk_pcompile(duk_context* ctx, unsigned /*flags*/) {
  const size_t level = ctx->top - 2;
  Frame frame;
  enterInside(ctx, frame);
  const int result = runProtected(ctx, frame, compile, nullptr);
  leaveFrame(ctx, frame, result < 0 ? level : level + 1);
  if (result < 0) push(ctx, JS_GetException(ctx->js));
  return result < 0 ? DUK_EXEC_ERROR : DUK_EXEC_SUCCESS;
}

void duk_eval_string(duk_context* ctx, const char* text) {
  duk_push_string(ctx, text);
  duk_push_string(ctx, "browser");
  compile(ctx, nullptr);
  duk_call(ctx, 0);
}

void duk_error_va(duk_context* ctx, int code, const char* format, va_list arguments) {
  char text[1024];
  std::vsnprintf(text, sizeof text, format, arguments);
  duk_push_string(ctx, text);
  JSValue message = valueAt(ctx, -1);
  const JSValueConst kind = code == DUK_ERR_RANGE_ERROR ? ctx->rangeError : ctx->typeError;
  const JSValue error = JS_CallConstructor(ctx->js, kind, 1, &message);
  if (!JS_IsException(error)) JS_Throw(ctx->js, error);
  fail(ctx);
}
