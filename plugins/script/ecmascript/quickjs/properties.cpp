// properties.cpp: Implements properties of objects. Hidden ones are in objects.cpp.
#include <cmath>
#include <cstring>

#include "stack.h"

using namespace ecma;

namespace {

// Pushes what a hidden property has; undefined: there is none.
bool pushHidden(ScriptStack* s, duk_idx_t object, const void* key) {
  const Entry* found = findHidden(s, valueAt(s, object), key);
  if (!found) {
    duk_push_undefined(s);
    return false;
  }
  const Entry entry = *found;
  if (entry.buffer)
    ++entry.buffer->uses;
  else
    JS_DupValue(s->js, entry.value);
  pushEntry(s, entry);
  return true;
}

bool pushFound(ScriptStack* s, JSValue value) {
  push(s, value);
  return !JS_IsUndefined(value);
}

// Turns the value on top into the key of a property.
JSAtom takeKey(ScriptStack* s) {
  const JSAtom key = JS_ValueToAtom(s->js, valueAt(s, -1));
  if (key == JS_ATOM_NULL) fail(s);
  duk_pop(s);
  return key;
}

// Returns a function that reads the variable of this name, which need not be declared.
JSValue makeReader(ScriptStack* s, const char* name) {
  for (const char* c = name; *c; ++c) {
    const bool letter = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || *c == '_' ||
                        *c == '$' || (c > name && *c >= '0' && *c <= '9');
    if (!letter) return JS_NULL;
  }
  duk_push_sprintf(s, "()=>typeof %s=='undefined'?void 0:%s", name, name);
  size_t bytes = 0;
  const char* text = duk_get_lstring(s, -1, &bytes);
  const JSValue reader = JS_Eval(s->js, text, bytes, "reader", JS_EVAL_TYPE_GLOBAL);
  duk_pop(s);
  if (!JS_IsException(reader)) return reader;
  JS_FreeValue(s->js, JS_GetException(s->js)); // a word of the language
  return JS_NULL;
}

// Pushes what `let`, `const` or `class` declares outside of functions.
void pushLexical(ScriptStack* s, const char* name) {
  JSValue reader = JS_GetPropertyStr(s->js, s->lexical, name);
  if (JS_IsUndefined(reader)) {
    reader = makeReader(s, name);
    check(s, JS_SetPropertyStr(s->js, s->lexical, name, JS_DupValue(s->js, reader)));
  }
  JSValue value =
      JS_IsNull(reader) ? JS_UNDEFINED : JS_Call(s->js, reader, JS_UNDEFINED, 0, nullptr);
  JS_FreeValue(s->js, reader);
  if (JS_IsException(value)) { // its declaration has not run
    JS_FreeValue(s->js, JS_GetException(s->js));
    value = JS_UNDEFINED;
  }
  push(s, value);
}

} // namespace

bool duk_get_prop(duk_context* ctx, duk_idx_t object) {
  object = duk_normalize_index(ctx, object);
  const JSAtom key = takeKey(ctx);
  const JSValue value = JS_GetProperty(ctx->js, valueAt(ctx, object), key);
  JS_FreeAtom(ctx->js, key);
  return pushFound(ctx, value);
}

bool duk_get_prop_index(duk_context* ctx, duk_idx_t object, duk_uarridx_t at) {
  return pushFound(ctx, JS_GetPropertyUint32(ctx->js, valueAt(ctx, object), at));
}

bool duk_get_prop_string(duk_context* ctx, duk_idx_t object, const char* key) {
  if (isHiddenName(key)) return pushHidden(ctx, object, hiddenName(ctx, key));
  return pushFound(ctx, JS_GetPropertyStr(ctx->js, valueAt(ctx, object), key));
}

bool duk_get_prop_heapptr(duk_context* ctx, duk_idx_t object, void* key) {
  return pushHidden(ctx, object, key);
}

void duk_put_prop(duk_context* ctx, duk_idx_t object) { // stack: key, value
  object = duk_normalize_index(ctx, object);
  duk_insert(ctx, -2);
  const JSAtom key = takeKey(ctx);
  const JSValue value = takeTop(ctx).value;
  const int done = JS_SetProperty(ctx->js, valueAt(ctx, object), key, value);
  JS_FreeAtom(ctx->js, key);
  check(ctx, done);
}

void duk_put_prop_index(duk_context* ctx, duk_idx_t object, duk_uarridx_t at) {
  const JSValueConst value = valueAt(ctx, object);
  const Entry entry = takeTop(ctx);
  if (entry.buffer) return freeEntry(ctx, entry); // a name, which is always kept
  check(ctx, JS_DefinePropertyValueUint32(ctx->js, value, at, entry.value,
                                          JS_PROP_C_W_E | JS_PROP_THROW));
}

void duk_put_prop_string(duk_context* ctx, duk_idx_t object, const char* key) {
  if (isHiddenName(key)) return duk_put_prop_heapptr(ctx, object, hiddenName(ctx, key));
  const JSValueConst value = valueAt(ctx, object);
  check(ctx, JS_SetPropertyStr(ctx->js, value, key, takeTop(ctx).value));
}

void duk_put_prop_heapptr(duk_context* ctx, duk_idx_t object, void* key) {
  const JSValueConst value = valueAt(ctx, object);
  setHidden(ctx, value, key, takeTop(ctx));
}

bool duk_has_prop(duk_context* ctx, duk_idx_t object) {
  object = duk_normalize_index(ctx, object);
  const JSAtom key = takeKey(ctx);
  const int has = JS_HasProperty(ctx->js, valueAt(ctx, object), key);
  JS_FreeAtom(ctx->js, key);
  check(ctx, has);
  return has > 0;
}

bool duk_has_prop_string(duk_context* ctx, duk_idx_t object, const char* key) {
  if (isHiddenName(key))
    return findHidden(ctx, valueAt(ctx, object), hiddenName(ctx, key)) != nullptr;
  object = duk_normalize_index(ctx, object);
  duk_push_string(ctx, key);
  return duk_has_prop(ctx, object);
}

void duk_del_prop(duk_context* ctx, duk_idx_t object) {
  object = duk_normalize_index(ctx, object);
  const JSAtom key = takeKey(ctx);
  const int done = JS_DeleteProperty(ctx->js, valueAt(ctx, object), key, 0);
  JS_FreeAtom(ctx->js, key);
  check(ctx, done);
}

void duk_del_prop_string(duk_context* ctx, duk_idx_t object, const char* key) {
  object = duk_normalize_index(ctx, object);
  duk_push_string(ctx, key);
  duk_del_prop(ctx, object);
}

void duk_def_prop(duk_context* ctx, duk_idx_t object, unsigned flags) { // key, value or functions
  object = duk_normalize_index(ctx, object);
  const bool value = flags & DUK_DEFPROP_HAVE_VALUE, getter = flags & DUK_DEFPROP_HAVE_GETTER,
             setter = flags & DUK_DEFPROP_HAVE_SETTER;
  const duk_idx_t first = duk_get_top(ctx) - (value ? 1 : int(getter) + int(setter));
  const int told =
      (value ? JS_PROP_HAS_VALUE : 0) | (getter ? JS_PROP_HAS_GET : 0) |
      (setter ? JS_PROP_HAS_SET : 0) |
      (flags & DUK_DEFPROP_HAVE_WRITABLE ? JS_PROP_HAS_WRITABLE : 0) |
      (flags & DUK_DEFPROP_SET_WRITABLE & ~DUK_DEFPROP_HAVE_WRITABLE ? JS_PROP_WRITABLE : 0) |
      (flags & DUK_DEFPROP_SET_ENUMERABLE ? JS_PROP_HAS_ENUMERABLE | JS_PROP_ENUMERABLE : 0) |
      (flags & DUK_DEFPROP_SET_CONFIGURABLE ? JS_PROP_HAS_CONFIGURABLE | JS_PROP_CONFIGURABLE : 0);
  const JSAtom key = JS_ValueToAtom(ctx->js, valueAt(ctx, first - 1));
  if (key == JS_ATOM_NULL) fail(ctx);
  const int done = JS_DefineProperty(
      ctx->js, valueAt(ctx, object), key, value ? valueAt(ctx, first) : JS_UNDEFINED,
      getter ? valueAt(ctx, first) : JS_UNDEFINED, setter ? valueAt(ctx, -1) : JS_UNDEFINED,
      told | JS_PROP_THROW);
  JS_FreeAtom(ctx->js, key);
  check(ctx, done);
  duk_set_top(ctx, first - 1);
}

bool duk_get_global_string(duk_context* ctx, const char* key) {
  duk_push_global_object(ctx);
  const bool found = duk_get_prop_string(ctx, -1, key);
  duk_remove(ctx, -2);
  if (found) return true;
  duk_pop(ctx);
  pushLexical(ctx, key);
  return !duk_is_undefined(ctx, -1);
}

void duk_put_global_string(duk_context* ctx, const char* key) {
  duk_push_global_object(ctx);
  duk_insert(ctx, -2);
  duk_put_prop_string(ctx, -2, key);
  duk_pop(ctx);
}

duk_size_t duk_get_length(duk_context* ctx, duk_idx_t object) {
  duk_get_prop_string(ctx, object, "length");
  const double length = duk_to_number(ctx, -1);
  duk_pop(ctx);
  return length > 0 && length < 0x1p53 ? duk_size_t(length) : 0;
}

void duk_set_length(duk_context* ctx, duk_idx_t object, duk_size_t length) {
  check(ctx, JS_SetPropertyStr(ctx->js, valueAt(ctx, object), "length",
                               JS_NewInt64(ctx->js, int64_t(length))));
}

bool duk_instanceof(duk_context* ctx, duk_idx_t object, duk_idx_t constructor) {
  const int is = JS_IsInstanceOf(ctx->js, valueAt(ctx, object), valueAt(ctx, constructor));
  check(ctx, is);
  return is > 0;
}
