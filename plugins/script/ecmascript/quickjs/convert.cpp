// convert.cpp: Implements texts, numbers and types of values on the stack.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "stack.h"

using namespace ecma;

namespace ecma {

void freeTexts(ScriptStack* s, size_t from) {
  while (s->textCount > from) JS_FreeCString(s->js, s->texts[--s->textCount]);
}

const char* textOf(ScriptStack* s, JSValueConst string, size_t* bytes) {
  if (s->textCount == s->textCapacity) {
    const size_t wanted = 2 * s->textCapacity + 64;
    auto* grown =
        static_cast<const char**>(js_realloc_rt(s->runtime, s->texts, wanted * sizeof(char*)));
    if (!grown) failMemory(s);
    s->texts = grown;
    s->textCapacity = wanted;
  }
  const char* text = JS_ToCStringLen(s->js, bytes, string);
  if (!text) fail(s);
  s->texts[s->textCount++] = text;
  return text;
}

namespace {

// Replaces the value at the index.
void replaceValue(ScriptStack* s, duk_idx_t index, JSValue value) {
  index = duk_normalize_index(s, index);
  push(s, value);
  duk_replace(s, index);
}

bool isText(ScriptStack* s, duk_idx_t index) { return JS_IsString(valueAt(s, index)); }

// Adds the text of a value to the buffer on top, which has `used` bytes.
size_t append(ScriptStack* s, duk_idx_t from, size_t used) {
  const size_t texts = s->textCount;
  size_t bytes = 0, room = 0;
  if (!isText(s, from)) duk_to_string(s, from);
  const char* text = textOf(s, valueAt(s, from), &bytes);
  duk_get_buffer(s, -1, &room);
  if (used + bytes > room) duk_resize_buffer(s, -1, 2 * (used + bytes));
  std::memcpy(static_cast<char*>(duk_get_buffer(s, -1, nullptr)) + used, text, bytes);
  freeTexts(s, texts);
  return used + bytes;
}

// Replaces the values on top by one text that has them all, with the separator between them.
void joinTexts(ScriptStack* s, duk_idx_t count, duk_idx_t separator) {
  const duk_idx_t first = duk_get_top(s) - count;
  size_t used = 0;
  duk_push_dynamic_buffer(s, 64);
  for (duk_idx_t i = 0; i < count; ++i) {
    if (i > 0 && separator >= 0) used = append(s, separator, used);
    used = append(s, first + i, used);
  }
  duk_push_lstring(s, static_cast<const char*>(duk_get_buffer(s, -1, nullptr)), used);
  duk_insert(s, first);
  duk_set_top(s, first + 1);
}

} // namespace
} // namespace ecma

void duk_push_string(duk_context* ctx, const char* text) {
  if (!text) return duk_push_null(ctx);
  if (!isHiddenName(text)) return duk_push_lstring(ctx, text, std::strlen(text));
  Buffer* name = hiddenName(ctx, text);
  ++name->uses;
  pushEntry(ctx, {JS_UNDEFINED, name});
}

void duk_push_lstring(duk_context* ctx, const char* text, duk_size_t bytes) {
  push(ctx, JS_NewStringLen(ctx->js, text ? text : "", bytes));
}

const char* duk_push_sprintf(duk_context* ctx, const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  auto* text = static_cast<char*>(js_malloc(ctx->js, size_t(length) + 1));
  if (text) std::vsnprintf(text, size_t(length) + 1, format, again);
  va_end(again);
  if (!text) fail(ctx);
  const JSValue made = JS_NewStringLen(ctx->js, text, size_t(length));
  js_free(ctx->js, text);
  push(ctx, made);
  return duk_get_string(ctx, -1);
}

const char* duk_get_lstring(duk_context* ctx, duk_idx_t index, duk_size_t* bytes) {
  if (bytes) *bytes = 0;
  return isText(ctx, index) ? textOf(ctx, valueAt(ctx, index), bytes) : nullptr;
}
const char* duk_get_string(duk_context* ctx, duk_idx_t index) {
  return duk_get_lstring(ctx, index, nullptr);
}

const char* duk_to_string(duk_context* ctx, duk_idx_t index) {
  replaceValue(ctx, index, JS_ToString(ctx->js, valueAt(ctx, index)));
  return duk_get_string(ctx, index);
}

const char* duk_safe_to_string(duk_context* ctx, duk_idx_t index) {
  JSValue text = JS_ToString(ctx->js, valueAt(ctx, index));
  if (JS_IsException(text)) {
    JS_FreeValue(ctx->js, JS_GetException(ctx->js));
    text = JS_NewString(ctx->js, JS_IsSymbol(valueAt(ctx, index)) ? "Symbol()" : "Error");
  }
  replaceValue(ctx, index, text);
  return duk_get_string(ctx, index);
}

void duk_concat(duk_context* ctx, duk_idx_t count) { joinTexts(ctx, count, -1); }

void duk_join(duk_context* ctx, duk_idx_t count) {
  const duk_idx_t separator = duk_get_top(ctx) - count - 1;
  joinTexts(ctx, count, separator);
  duk_remove(ctx, separator);
}

double duk_to_number(duk_context* ctx, duk_idx_t index) {
  double number = 0;
  check(ctx, JS_ToFloat64(ctx->js, &number, valueAt(ctx, index)));
  replaceValue(ctx, index, JS_NewFloat64(ctx->js, number));
  return number;
}

int32_t duk_to_int32(duk_context* ctx, duk_idx_t index) {
  int32_t number = 0;
  check(ctx, JS_ToInt32(ctx->js, &number, valueAt(ctx, index)));
  return number;
}

// QuickJS has no function for this. An object whose value is no number gives the text NaN, which
// differs from the number NaN.
void duk_to_primitive(duk_context* ctx, duk_idx_t index, int /*hint*/) {
  double number = 0;
  check(ctx, JS_ToFloat64(ctx->js, &number, valueAt(ctx, index)));
  replaceValue(ctx, index,
               std::isnan(number) ? JS_NewString(ctx->js, "NaN") : JS_NewFloat64(ctx->js, number));
}

bool duk_get_boolean(duk_context* ctx, duk_idx_t index) {
  const JSValueConst value = valueAt(ctx, index);
  return JS_IsBool(value) && JS_VALUE_GET_BOOL(value);
}

double duk_get_number(duk_context* ctx, duk_idx_t index) {
  const JSValueConst value = valueAt(ctx, index);
  double number = NAN;
  if (JS_IsNumber(value)) JS_ToFloat64(ctx->js, &number, value); // runs nothing of the program
  return number;
}

unsigned duk_get_uint_default(duk_context* ctx, duk_idx_t index, unsigned otherwise) {
  return duk_is_number(ctx, index) ? unsigned(duk_get_number(ctx, index)) : otherwise;
}

bool duk_is_undefined(duk_context* ctx, duk_idx_t index) {
  const size_t place = placeOf(ctx, index);
  return !(place < ctx->top && ctx->entries[place].buffer) && JS_IsUndefined(valueAt(ctx, index));
}
bool duk_is_null(duk_context* ctx, duk_idx_t index) { return JS_IsNull(valueAt(ctx, index)); }
bool duk_is_null_or_undefined(duk_context* ctx, duk_idx_t index) {
  return duk_is_null(ctx, index) || duk_is_undefined(ctx, index);
}
bool duk_is_boolean(duk_context* ctx, duk_idx_t index) { return JS_IsBool(valueAt(ctx, index)); }
bool duk_is_number(duk_context* ctx, duk_idx_t index) { return JS_IsNumber(valueAt(ctx, index)); }
bool duk_is_string(duk_context* ctx, duk_idx_t index) { return isText(ctx, index); }
bool duk_is_object(duk_context* ctx, duk_idx_t index) { return JS_IsObject(valueAt(ctx, index)); }

bool duk_is_array(duk_context* ctx, duk_idx_t index) {
  const int array = JS_IsArray(ctx->js, valueAt(ctx, index));
  if (array < 0) JS_FreeValue(ctx->js, JS_GetException(ctx->js)); // a revoked proxy
  return array > 0;
}

bool duk_is_function(duk_context* ctx, duk_idx_t index) {
  return JS_IsFunction(ctx->js, valueAt(ctx, index));
}
bool duk_is_callable(duk_context* ctx, duk_idx_t index) { return duk_is_function(ctx, index); }
bool duk_is_error(duk_context* ctx, duk_idx_t index) {
  return JS_IsError(ctx->js, valueAt(ctx, index));
}

bool duk_is_buffer_data(duk_context* ctx, duk_idx_t index) {
  const JSClassID id = JS_GetClassID(valueAt(ctx, index));
  for (const JSClassID array : ctx->arrayClasses)
    if (id == array && id != JS_INVALID_CLASS_ID) return true;
  return false;
}
