// stack.cpp: Implements the stack of values: pushing, moving and buffers.
#include "stack.h"

#include <cstring>

using namespace ecma;

namespace ecma {
namespace {

constexpr size_t spare = 16; // entries kept free for finalizers, which must not fail

Buffer* makeBuffer(ScriptStack* s, size_t bytes, bool separate) {
  if (bytes > SIZE_MAX / 2) return nullptr;
  auto* buffer =
      static_cast<Buffer*>(js_mallocz_rt(s->runtime, sizeof(Buffer) + (separate ? 0 : bytes)));
  if (!buffer) return nullptr;
  *buffer = {1, bytes, separate, buffer + 1};
  if (!separate) return buffer;
  buffer->data = js_mallocz_rt(s->runtime, bytes > 0 ? bytes : 1);
  if (buffer->data) return buffer;
  js_free_rt(s->runtime, buffer);
  return nullptr;
}

void* pushBuffer(ScriptStack* s, size_t bytes, bool separate) {
  Buffer* buffer = makeBuffer(s, bytes, separate);
  if (!buffer) failMemory(s);
  pushEntry(s, {JS_UNDEFINED, buffer});
  return buffer->data;
}

} // namespace

bool reserve(ScriptStack* s) {
  if (s->top + spare < s->capacity) return true;
  const size_t wanted = 2 * s->capacity + 4 * spare;
  auto* grown = static_cast<Entry*>(js_realloc_rt(s->runtime, s->entries, wanted * sizeof(Entry)));
  if (!grown) return false;
  s->entries = grown;
  s->capacity = wanted;
  return true;
}

void freeBuffer(JSRuntime* runtime, Buffer* buffer) {
  if (--buffer->uses > 0) return;
  if (buffer->separate) js_free_rt(runtime, buffer->data);
  js_free_rt(runtime, buffer);
}

void freeEntry(ScriptStack* s, Entry entry) {
  if (entry.buffer)
    freeBuffer(s->runtime, entry.buffer);
  else
    JS_FreeValue(s->js, entry.value);
}

void pushEntry(ScriptStack* s, Entry entry) {
  // a finalizer uses the spare entries
  if (!s->frame->finalizes && !reserve(s)) {
    freeEntry(s, entry);
    failMemory(s);
  }
  s->entries[s->top++] = entry;
}

void push(ScriptStack* s, JSValue value) {
  if (JS_IsException(value)) fail(s);
  pushEntry(s, {value, nullptr});
}

Entry takeTop(ScriptStack* s) { return s->entries[--s->top]; }

void truncate(ScriptStack* s, size_t top) {
  while (s->top > top) freeEntry(s, takeTop(s));
}

size_t placeOf(const ScriptStack* s, duk_idx_t index) {
  return index < 0 ? s->top - size_t(-index) : s->frame->base + size_t(index);
}

JSValueConst valueAt(const ScriptStack* s, duk_idx_t index) {
  const size_t place = placeOf(s, index);
  return place < s->top && !s->entries[place].buffer ? s->entries[place].value : JS_UNDEFINED;
}

Buffer* hiddenName(ScriptStack* s, const char* name) {
  const size_t bytes = std::strlen(name) + 1;
  for (Buffer*& known : s->names) {
    if (known && std::strcmp(static_cast<const char*>(known->data), name) != 0) continue;
    if (!known) {
      known = makeBuffer(s, bytes, false);
      if (!known) failMemory(s);
      std::memcpy(known->data, name, bytes);
    }
    return known;
  }
  JS_ThrowInternalError(s->js, "more than %d hidden names", int(mostNames));
  fail(s);
}

} // namespace ecma

duk_idx_t duk_get_top(duk_context* ctx) { return duk_idx_t(ctx->top - ctx->frame->base); }
duk_idx_t duk_get_top_index(duk_context* ctx) { return duk_get_top(ctx) - 1; }
duk_idx_t duk_normalize_index(duk_context* ctx, duk_idx_t index) {
  return index < 0 ? duk_get_top(ctx) + index : index;
}

void duk_set_top(duk_context* ctx, duk_idx_t count) {
  const size_t wanted = ctx->frame->base + size_t(count);
  while (ctx->top < wanted) push(ctx, JS_UNDEFINED);
  truncate(ctx, wanted);
}
void duk_pop(duk_context* ctx) { truncate(ctx, ctx->top - 1); }
void duk_pop_2(duk_context* ctx) { truncate(ctx, ctx->top - 2); }
void duk_pop_n(duk_context* ctx, duk_idx_t count) { truncate(ctx, ctx->top - size_t(count)); }

void duk_dup(duk_context* ctx, duk_idx_t index) {
  const size_t place = placeOf(ctx, index);
  if (place >= ctx->top) return push(ctx, JS_UNDEFINED);
  const Entry entry = ctx->entries[place];
  if (entry.buffer)
    ++entry.buffer->uses;
  else
    JS_DupValue(ctx->js, entry.value);
  pushEntry(ctx, entry);
}

void duk_insert(duk_context* ctx, duk_idx_t to) {
  const size_t place = placeOf(ctx, to);
  const Entry entry = ctx->entries[ctx->top - 1];
  std::memmove(ctx->entries + place + 1, ctx->entries + place,
               (ctx->top - 1 - place) * sizeof(Entry));
  ctx->entries[place] = entry;
}

void duk_remove(duk_context* ctx, duk_idx_t index) {
  const size_t place = placeOf(ctx, index);
  const Entry entry = ctx->entries[place];
  std::memmove(ctx->entries + place, ctx->entries + place + 1,
               (--ctx->top - place) * sizeof(Entry));
  freeEntry(ctx, entry);
}

void duk_replace(duk_context* ctx, duk_idx_t to) {
  const size_t place = placeOf(ctx, to);
  const Entry old = ctx->entries[place];
  ctx->entries[place] = takeTop(ctx);
  freeEntry(ctx, old);
}

void duk_push_undefined(duk_context* ctx) { push(ctx, JS_UNDEFINED); }
void duk_push_null(duk_context* ctx) { push(ctx, JS_NULL); }
void duk_push_boolean(duk_context* ctx, bool value) { push(ctx, JS_NewBool(ctx->js, value)); }
void duk_push_true(duk_context* ctx) { push(ctx, JS_TRUE); }
void duk_push_false(duk_context* ctx) { push(ctx, JS_FALSE); }
void duk_push_int(duk_context* ctx, int value) { push(ctx, JS_NewInt32(ctx->js, value)); }
void duk_push_uint(duk_context* ctx, unsigned value) { push(ctx, JS_NewUint32(ctx->js, value)); }
void duk_push_number(duk_context* ctx, double value) { push(ctx, JS_NewFloat64(ctx->js, value)); }
void duk_push_global_object(duk_context* ctx) { push(ctx, JS_GetGlobalObject(ctx->js)); }
void duk_push_global_stash(duk_context* ctx) { push(ctx, JS_DupValue(ctx->js, ctx->stash)); }

void duk_push_heapptr(duk_context* ctx, void* object) {
  push(ctx, JS_DupValue(ctx->js, objectAt(object)));
}

void* duk_get_heapptr(duk_context* ctx, duk_idx_t index) {
  const size_t place = placeOf(ctx, index);
  if (place < ctx->top && ctx->entries[place].buffer) return ctx->entries[place].buffer;
  const JSValueConst value = valueAt(ctx, index);
  return JS_IsObject(value) ? JS_VALUE_GET_PTR(value) : nullptr;
}

duk_idx_t duk_push_array(duk_context* ctx) {
  push(ctx, JS_NewArray(ctx->js));
  return duk_get_top_index(ctx);
}

void* duk_push_fixed_buffer(duk_context* ctx, duk_size_t bytes) {
  return pushBuffer(ctx, bytes, false);
}
void* duk_push_dynamic_buffer(duk_context* ctx, duk_size_t bytes) {
  return pushBuffer(ctx, bytes, true);
}

void* duk_resize_buffer(duk_context* ctx, duk_idx_t index, duk_size_t bytes) {
  Buffer* buffer = ctx->entries[placeOf(ctx, index)].buffer;
  void* grown = js_realloc_rt(ctx->runtime, buffer->data, bytes > 0 ? bytes : 1);
  if (!grown) failMemory(ctx);
  if (bytes > buffer->bytes)
    std::memset(static_cast<char*>(grown) + buffer->bytes, 0, bytes - buffer->bytes);
  buffer->data = grown;
  buffer->bytes = bytes;
  return grown;
}

void* duk_get_buffer(duk_context* ctx, duk_idx_t index, duk_size_t* bytes) {
  const size_t place = placeOf(ctx, index);
  const Buffer* buffer = place < ctx->top ? ctx->entries[place].buffer : nullptr;
  if (bytes) *bytes = buffer ? buffer->bytes : 0;
  return buffer ? buffer->data : nullptr;
}
