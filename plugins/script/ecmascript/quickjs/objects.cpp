// objects.cpp: Implements objects with hidden properties and finalizers, and proxies, as classes of
// QuickJS. No symbol stands for a hidden property, so no program can reach one.
#include "stack.h"

using namespace ecma;

namespace ecma {
namespace {

ScriptStack* stackOf(JSRuntime* runtime) {
  return static_cast<ScriptStack*>(JS_GetRuntimeOpaque(runtime));
}
ScriptStack* stackOf(JSContext* js) { return static_cast<ScriptStack*>(JS_GetContextOpaque(js)); }

// --- Objects ---

Hidden* hiddenOf(const ScriptStack* s, JSValueConst object) {
  return static_cast<Hidden*>(JS_GetOpaque(object, s->objectClass));
}

// Returns what the object hides; it is made on first use.
Hidden* needHidden(ScriptStack* s, JSValueConst object) {
  if (Hidden* hidden = hiddenOf(s, object)) return hidden;
  auto* made = static_cast<Hidden*>(js_mallocz_rt(s->runtime, sizeof(Hidden)));
  if (!made) failMemory(s);
  JS_SetOpaque(object, made);
  return made;
}

Hidden::Property* findOwn(const Hidden* hidden, const void* key) {
  for (uint32_t i = 0; hidden && i < hidden->count; ++i)
    if (hidden->properties[i].key == key) return hidden->properties + i;
  return nullptr;
}

int runFinalizer(ScriptStack* s, void* function) {
  return (*static_cast<duk_c_function*>(function))(s);
}

// Calls the finalizer with the object, which is about to go: its entry must not count as a use.
void finalize(ScriptStack* s, duk_c_function function, JSValueConst object) {
  Frame frame;
  enterFrame(s, frame, JS_UNDEFINED, 0);
  frame.finalizes = true;
  pushEntry(s, {object, nullptr});
  runProtected(s, frame, runFinalizer, static_cast<void*>(&function));
  s->entries[frame.base].value = JS_UNDEFINED;
  leaveFrame(s, frame, frame.base);
}

void finalizeObject(JSRuntime* runtime, JSValue object) {
  ScriptStack* s = stackOf(runtime);
  Hidden* hidden = hiddenOf(s, object);
  if (!hidden) return;
  if (hidden->finalizer) finalize(s, hidden->finalizer, object);
  for (uint32_t i = 0; i < hidden->count; ++i) {
    const Entry entry = hidden->properties[i].entry;
    if (entry.buffer)
      freeBuffer(runtime, entry.buffer);
    else
      JS_FreeValueRT(runtime, entry.value);
  }
  js_free_rt(runtime, hidden->properties);
  js_free_rt(runtime, hidden);
}

void markObject(JSRuntime* runtime, JSValueConst object, JS_MarkFunc* mark) {
  const Hidden* hidden = hiddenOf(stackOf(runtime), object);
  for (uint32_t i = 0; hidden && i < hidden->count; ++i)
    if (!hidden->properties[i].entry.buffer)
      JS_MarkValue(runtime, hidden->properties[i].entry.value, mark);
}

const JSClassDef objectClass = {"Object", finalizeObject, markObject, nullptr, nullptr};

// --- Proxies: the opaque pointer is the target ---

JSValueConst targetOf(const ScriptStack* s, JSValueConst list) {
  return objectAt(JS_GetOpaque(list, s->listClass));
}

void finalizeList(JSRuntime* runtime, JSValue list) {
  if (void* target = JS_GetOpaque(list, stackOf(runtime)->listClass))
    JS_FreeValueRT(runtime, objectAt(target));
}
void markList(JSRuntime* runtime, JSValueConst list, JS_MarkFunc* mark) {
  if (void* target = JS_GetOpaque(list, stackOf(runtime)->listClass))
    JS_MarkValue(runtime, objectAt(target), mark);
}

JSValue callTrap(JSContext* js, Trap trap, JSValueConst list, JSAtom key, int count,
                 JSValueConst third, JSValueConst fourth) {
  const ScriptStack* s = stackOf(js);
  JSValue name = JS_AtomToValue(js, key);
  if (JS_IsException(name)) return name;
  JSValue arguments[] = {targetOf(s, list), name, third, fourth};
  const JSValue result = JS_Call(js, s->trap[trap], JS_UNDEFINED, count, arguments);
  JS_FreeValue(js, name);
  return result;
}

int answer(JSContext* js, JSValue result) {
  if (JS_IsException(result)) return -1;
  const int truth = JS_ToBool(js, result);
  JS_FreeValue(js, result);
  return truth;
}

int getOwn(JSContext* js, JSPropertyDescriptor* descriptor, JSValueConst list, JSAtom key) {
  return JS_GetOwnProperty(js, descriptor, targetOf(stackOf(js), list), key);
}
int getOwnNames(JSContext* js, JSPropertyEnum** names, uint32_t* count, JSValueConst list) {
  return JS_GetOwnPropertyNames(js, names, count, targetOf(stackOf(js), list),
                                JS_GPN_STRING_MASK | JS_GPN_SYMBOL_MASK);
}
int defineOwn(JSContext* js, JSValueConst list, JSAtom key, JSValueConst value, JSValueConst getter,
              JSValueConst setter, int flags) {
  return JS_DefineProperty(js, targetOf(stackOf(js), list), key, value, getter, setter, flags);
}
int remove(JSContext* js, JSValueConst list, JSAtom key) {
  return answer(js, callTrap(js, trapDelete, list, key, 2, JS_UNDEFINED, JS_UNDEFINED));
}
int has(JSContext* js, JSValueConst list, JSAtom key) {
  return answer(js, callTrap(js, trapHas, list, key, 2, JS_UNDEFINED, JS_UNDEFINED));
}
JSValue get(JSContext* js, JSValueConst list, JSAtom key, JSValueConst receiver) {
  return callTrap(js, trapGet, list, key, 3, receiver, JS_UNDEFINED);
}
int set(JSContext* js, JSValueConst list, JSAtom key, JSValueConst value, JSValueConst receiver,
        int /*flags*/) {
  return answer(js, callTrap(js, trapSet, list, key, 4, value, receiver));
}

// not const, because the class has a pointer to what may be written
JSClassExoticMethods listMethods = {getOwn, getOwnNames, remove,  defineOwn, has,    get,
                                    set,    nullptr,     nullptr, nullptr,   nullptr};
const JSClassDef listClass = {"Object", finalizeList, markList, nullptr, &listMethods};

// Fetches the traps from the object on top, which is the same for all proxies.
void fetchTraps(ScriptStack* s) {
  static constexpr const char* names[] = {"get", "set", "has", "deleteProperty"};
  if (s->traps == duk_get_heapptr(s, -1)) return;
  for (int i = 0; i < trapCount; ++i) {
    const JSValue trap = JS_GetPropertyStr(s->js, valueAt(s, -1), names[i]);
    if (JS_IsException(trap)) fail(s);
    s->trap[i] = trap;
  }
  s->traps = duk_get_heapptr(s, -1);
}

} // namespace

int registerObjects(ScriptStack* s) {
  static const JSClassID objects = [] {
    JSClassID id = 0;
    return JS_NewClassID(&id);
  }();
  static const JSClassID lists = [] {
    JSClassID id = 0;
    return JS_NewClassID(&id);
  }();
  s->objectClass = objects;
  s->listClass = lists;
  const int made = JS_NewClass(s->runtime, objects, &objectClass);
  return made < 0 ? made : JS_NewClass(s->runtime, lists, &listClass);
}

const Entry* findHidden(ScriptStack* s, JSValueConst object, const void* key) {
  const Entry* found = nullptr;
  JSValue held = JS_UNDEFINED; // the prototype that `object` is
  if (JS_GetClassID(object) == s->listClass) object = targetOf(s, object);
  while (JS_IsObject(object)) {
    const JSClassID id = JS_GetClassID(object);
    const Hidden::Property* own =
        id == s->objectClass ? findOwn(hiddenOf(s, object), key) : nullptr;
    if (own) found = &own->entry; // the object on the stack keeps its prototypes
    // a proxy's trap would run the program here
    if (own || id == s->proxyClass || s->frame->finalizes) break;
    const JSValue next = JS_GetPrototype(s->js, object);
    JS_FreeValue(s->js, held);
    held = object = next;
  }
  JS_FreeValue(s->js, held);
  return found;
}

void setHidden(ScriptStack* s, JSValueConst object, const void* key, Entry entry) {
  if (JS_GetClassID(object) == s->listClass) object = targetOf(s, object);
  // while it is made, the entry has to be on the stack
  pushEntry(s, entry);
  if (JS_GetClassID(object) != s->objectClass) {
    JS_ThrowTypeError(s->js, "not an object of the browser");
    fail(s);
  }
  Hidden* hidden = needHidden(s, object);
  if (Hidden::Property* own = findOwn(hidden, key)) {
    const Entry old = own->entry;
    own->entry = takeTop(s);
    return freeEntry(s, old);
  }
  if (hidden->count == hidden->capacity) {
    const uint32_t wanted = hidden->capacity + 2;
    auto* grown = static_cast<Hidden::Property*>(
        js_realloc_rt(s->runtime, hidden->properties, wanted * sizeof(Hidden::Property)));
    if (!grown) failMemory(s);
    hidden->properties = grown;
    hidden->capacity = wanted;
  }
  hidden->properties[hidden->count++] = {key, takeTop(s)};
}

int derive(ScriptStack* s, JSValueConst object, JSValueConst prototype) {
  const Hidden* hidden = hiddenOf(s, object);
  if (hidden && hidden->finalizer) return 0; // a node, which others may know
  const int done = JS_SetPrototype(s->js, object, prototype);
  if (done < 0 || JS_GetClassID(object) != s->listClass) return done;
  return JS_SetPrototype(s->js, targetOf(s, object), prototype);
}

} // namespace ecma

duk_idx_t duk_push_object(duk_context* ctx) {
  push(ctx, JS_NewObjectProtoClass(ctx->js, ctx->objectPrototype, ctx->objectClass));
  return duk_get_top_index(ctx);
}

duk_idx_t duk_push_bare_object(duk_context* ctx) {
  push(ctx, JS_NewObjectProtoClass(ctx->js, JS_NULL, ctx->objectClass));
  return duk_get_top_index(ctx);
}

void duk_push_proxy(duk_context* ctx, unsigned /*flags*/) {
  fetchTraps(ctx);
  duk_pop(ctx);
  duk_get_prototype(ctx, -1);
  const JSValue list = JS_NewObjectProtoClass(ctx->js, valueAt(ctx, -1), ctx->listClass);
  if (JS_IsException(list)) fail(ctx);
  duk_pop(ctx);
  JS_SetOpaque(list, JS_VALUE_GET_PTR(takeTop(ctx).value));
  push(ctx, list);
}

void duk_get_prototype(duk_context* ctx, duk_idx_t object) {
  const JSValueConst value = valueAt(ctx, object);
  const bool foreign = JS_GetClassID(value) == ctx->proxyClass;
  push(ctx, foreign ? JS_NULL : JS_GetPrototype(ctx->js, value));
}

void duk_set_prototype(duk_context* ctx, duk_idx_t object) {
  const JSValueConst value = valueAt(ctx, object), prototype = valueAt(ctx, -1);
  check(ctx, JS_SetPrototype(ctx->js, value, prototype));
  const Hidden* above = hiddenOf(ctx, prototype);
  if (above && above->finalizer) needHidden(ctx, value)->finalizer = above->finalizer;
  duk_pop(ctx);
}

void duk_set_finalizer(duk_context* ctx, duk_idx_t object) {
  const Native* native = nativeAt(ctx, valueAt(ctx, -1));
  needHidden(ctx, valueAt(ctx, object))->finalizer = native->function;
  duk_pop(ctx);
}
