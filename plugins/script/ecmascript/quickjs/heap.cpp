// heap.cpp: Creates the runtime of QuickJS for one Script: memory, stack, and the watchdog.
#include <cstring>

#include "../interpreter.h"
#include "stack.h"

using namespace ecma;

namespace {

// --- Memory. QuickJS collects garbage when malloc_size has grown ---

ScriptStack* owner(const JSMallocState* state) { return static_cast<ScriptStack*>(state->opaque); }

Interpreter& of(const ScriptStack* s) { return *static_cast<Interpreter*>(s->memory.udata); }

// Notes what is used. If there was no memory, the Script ends: QuickJS does not survive it in all
// places, such as its compiler.
void* counted(JSMallocState* state, void* block, size_t bytes) {
  ScriptStack* s = owner(state);
  state->malloc_size = of(s).used;
  if (block || bytes == 0) return block;
  s->fatal(s->memory.udata, "out of memory; the Script ends");
  return nullptr; // never reached
}
// A new block that is larger than all memory is an error of the program, as of `new Uint8Array`.
void* allocate(JSMallocState* state, size_t bytes) {
  const duk_memory_functions& memory = owner(state)->memory;
  if (const uint64_t most = of(owner(state)).most; most > 0 && bytes > most) return nullptr;
  return counted(state, memory.alloc_func(memory.udata, bytes), bytes);
}
void release(JSMallocState* state, void* block) {
  const duk_memory_functions& memory = owner(state)->memory;
  memory.free_func(memory.udata, block);
  counted(state, nullptr, 0);
}
void* reallocate(JSMallocState* state, void* block, size_t bytes) {
  const duk_memory_functions& memory = owner(state)->memory;
  return counted(state, memory.realloc_func(memory.udata, block, bytes), bytes);
}
size_t unknownSize(const void*) { return 0; }

const JSMallocFunctions allocator = {allocate, release, reallocate, unknownSize};

// --- Limits ---

int interrupt(JSRuntime*, void* data) {
  auto* s = static_cast<ScriptStack*>(data);
  constexpr uint32_t steps = 10'000; // calls and backward jumps between two questions
  const uint64_t used = of(s).used, most = of(s).most;
  // QuickJS collects when memory has grown by half, which may be beyond the limit
  if (most > 0 && used > most / 4 * 3 && used > s->collected + most / 16) {
    JS_RunGC(s->runtime);
    s->collected = of(s).used;
  }
  s->stopped = mustStop(of(s), steps);
  return s->stopped;
}

// --- The language ---

bool prepare(ScriptStack* s) {
  static constexpr const char* text =
      "[Object.prototype,Function.prototype,TypeError,RangeError,new Proxy({},{}),"
      "new Uint8ClampedArray(0),new Int8Array(0),new Uint8Array(0),new Int16Array(0),"
      "new Uint16Array(0),new Int32Array(0),new Uint32Array(0),new Float32Array(0),"
      "new Float64Array(0)]";
  const JSValue list = JS_Eval(s->js, text, std::strlen(text), "browser", JS_EVAL_TYPE_GLOBAL);
  if (JS_IsException(list)) return false;
  const auto at = [&](uint32_t i) { return JS_GetPropertyUint32(s->js, list, i); };
  s->objectPrototype = at(0);
  s->functionPrototype = at(1);
  s->typeError = at(2);
  s->rangeError = at(3);
  constexpr uint32_t proxy = 4;
  for (uint32_t i = proxy; i <= proxy + typedArrays; ++i) {
    const JSValue example = at(i);
    (i == proxy ? s->proxyClass : s->arrayClasses[i - proxy - 1]) = JS_GetClassID(example);
    JS_FreeValue(s->js, example);
  }
  JS_FreeValue(s->js, list);
  s->stash = JS_NewObjectProtoClass(s->js, JS_NULL, s->objectClass);
  s->lexical = JS_NewObjectProto(s->js, JS_NULL);
  s->rejected = JS_NewArray(s->js);
  // A program may change Array.prototype, and that must not show here.
  return JS_IsObject(s->stash) && JS_IsObject(s->lexical) && JS_IsObject(s->rejected) &&
         JS_SetPrototype(s->js, s->rejected, JS_NULL) >= 0;
}

// Adds what ECMAScript 2020 has; weak references, which show the collector, are newer.
void addLanguage(JSContext* js) {
  JS_AddIntrinsicBaseObjects(js);
  JS_AddIntrinsicDate(js);
  JS_AddIntrinsicEval(js);
  JS_AddIntrinsicStringNormalize(js);
  JS_AddIntrinsicRegExp(js);
  JS_AddIntrinsicJSON(js);
  JS_AddIntrinsicProxy(js);
  JS_AddIntrinsicMapSet(js);
  JS_AddIntrinsicTypedArrays(js);
  JS_AddIntrinsicPromise(js);
}

bool create(ScriptStack* s) {
  s->runtime = JS_NewRuntime2(&allocator, s);
  if (!s->runtime) return false;
  JS_SetRuntimeOpaque(s->runtime, s);
  JS_SetMaxStackSize(s->runtime, stackBytes);
  s->js = JS_NewContextRaw(s->runtime);
  if (!s->js || registerObjects(s) < 0 || registerFunctions(s) < 0) return false;
  JS_SetContextOpaque(s->js, s);
  addLanguage(s->js);
  JS_SetInterruptHandler(s->runtime, interrupt, s);
  watchJobs(s);
  return prepare(s) && reserve(s);
}

} // namespace

duk_context* duk_create_heap(void* (*allocate)(void*, duk_size_t),
                             void* (*reallocate)(void*, void*, duk_size_t),
                             void (*release)(void*, void*), void* udata, duk_fatal_function fatal) {
  auto* s = static_cast<ScriptStack*>(allocate(udata, sizeof(ScriptStack)));
  if (!s) return nullptr;
  std::memset(static_cast<void*>(s), 0, sizeof *s);
  s->memory = {allocate, reallocate, release, udata};
  s->fatal = fatal;
  s->frame = &s->bottom;
  s->bottom.self = JS_UNDEFINED;
  return create(s) ? s : nullptr;
}

void duk_destroy_heap(duk_context*) {}

void duk_get_memory_functions(duk_context* ctx, duk_memory_functions* functions) {
  *functions = ctx->memory;
}
