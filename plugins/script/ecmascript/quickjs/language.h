// language.h: Gives the engine QuickJS the part of Duktape's stack API that the objects of Annex C
// use, so that they are written once. See https://duktape.org/api.html for the functions. [the
// browser's thread]
//
// Errors are reported with longjmp to the innermost protected call or native function, as in
// Duktape. It differs from Duktape in this:
// * Hidden properties and finalizers exist only on objects made by duk_push_object(),
//   duk_push_bare_object() and duk_push_proxy(), and on what inherits from them.
// * A buffer can be only the value of a hidden property, so no program ever gets one.
// * The key of duk_get_prop_heapptr() and duk_put_prop_heapptr() is a hidden one.
// * A text that duk_get_string() returns is valid until the native function returns.
// * duk_put_prop_index() defines the property, without setters of prototypes.
// * Proxies have the traps get, set, has and deleteProperty, the same for all of them.
#pragma once

#include <cstdarg>
#include <cstddef>
#include <cstdint>

namespace ecma {

constexpr const char* engineText =
    "ECMAScript 2020 with the objects of ISO/IEC 14772-1 Annex C, on QuickJS";

} // namespace ecma

struct ScriptStack; // stack.h
using duk_context = ScriptStack;
using duk_idx_t = int;
using duk_ret_t = int;
using duk_size_t = size_t;
using duk_uarridx_t = uint32_t;
using duk_c_function = duk_ret_t (*)(duk_context*);
using duk_safe_call_function = duk_ret_t (*)(duk_context*, void*);
using duk_fatal_function = void (*)(void* udata, const char* message);

struct duk_memory_functions {
  void* (*alloc_func)(void* udata, duk_size_t bytes);
  void* (*realloc_func)(void* udata, void* memory, duk_size_t bytes);
  void (*free_func)(void* udata, void* memory);
  void* udata;
};

// NOLINTBEGIN(cppcoreguidelines-macro-usage)
#define DUK_HIDDEN_SYMBOL(name) "\xff" name
// NOLINTEND(cppcoreguidelines-macro-usage)
constexpr int DUK_VARARGS = -1;
enum { DUK_EXEC_SUCCESS, DUK_EXEC_ERROR };
enum { DUK_ERR_TYPE_ERROR, DUK_ERR_RANGE_ERROR };
enum { DUK_HINT_NUMBER = 2 };
enum : unsigned {
  DUK_DEFPROP_HAVE_VALUE = 1,
  DUK_DEFPROP_HAVE_GETTER = 2,
  DUK_DEFPROP_HAVE_SETTER = 4,
  DUK_DEFPROP_HAVE_WRITABLE = 8,
  DUK_DEFPROP_SET_WRITABLE = 8 | 16,
  DUK_DEFPROP_SET_ENUMERABLE = 32,
  DUK_DEFPROP_SET_CONFIGURABLE = 64,
  DUK_DEFPROP_FORCE = 128
};

// --- heap.cpp ---
duk_context* duk_create_heap(void* (*allocate)(void*, duk_size_t),
                             void* (*reallocate)(void*, void*, duk_size_t),
                             void (*release)(void*, void*), void* udata, duk_fatal_function fatal);
// Forgets the heap; its owner frees all blocks at once. No finalizer runs.
void duk_destroy_heap(duk_context* ctx);
void duk_get_memory_functions(duk_context* ctx, duk_memory_functions* functions);

// --- calls.cpp ---
void duk_push_c_function(duk_context* ctx, duk_c_function function, duk_idx_t arguments);
void duk_set_magic(duk_context* ctx, duk_idx_t function, int magic);
int duk_get_current_magic(duk_context* ctx);
void duk_push_this(duk_context* ctx);
void duk_call(duk_context* ctx, duk_idx_t arguments);
void duk_call_prop(duk_context* ctx, duk_idx_t object, duk_idx_t arguments);
// Calls the function in a protected call. The outermost one then runs the jobs of promises; a
// rejection that nobody handles is the error of the call.
int duk_safe_call(duk_context* ctx, duk_safe_call_function function, void* udata,
                  duk_idx_t arguments, duk_idx_t results);
void duk_compile(duk_context* ctx, unsigned flags); // stack: text, file name
int duk_pcompile(duk_context* ctx, unsigned flags);
void duk_eval_string(duk_context* ctx, const char* text);
[[noreturn]] void duk_error_va(duk_context* ctx, int code, const char* format, va_list arguments);
[[noreturn]] void duk_throw(duk_context* ctx);

// --- stack.cpp ---
duk_idx_t duk_get_top(duk_context* ctx);
duk_idx_t duk_get_top_index(duk_context* ctx);
duk_idx_t duk_normalize_index(duk_context* ctx, duk_idx_t index);
void duk_set_top(duk_context* ctx, duk_idx_t count);
void duk_pop(duk_context* ctx);
void duk_pop_2(duk_context* ctx);
void duk_pop_n(duk_context* ctx, duk_idx_t count);
void duk_dup(duk_context* ctx, duk_idx_t index);
void duk_insert(duk_context* ctx, duk_idx_t to);
void duk_remove(duk_context* ctx, duk_idx_t index);
void duk_replace(duk_context* ctx, duk_idx_t to);
void duk_push_undefined(duk_context* ctx);
void duk_push_null(duk_context* ctx);
void duk_push_boolean(duk_context* ctx, bool value);
void duk_push_true(duk_context* ctx);
void duk_push_false(duk_context* ctx);
void duk_push_int(duk_context* ctx, int value);
void duk_push_uint(duk_context* ctx, unsigned value);
void duk_push_number(duk_context* ctx, double value);
void duk_push_global_object(duk_context* ctx);
void duk_push_global_stash(duk_context* ctx);
void duk_push_heapptr(duk_context* ctx, void* object);
void* duk_get_heapptr(duk_context* ctx, duk_idx_t index);
duk_idx_t duk_push_array(duk_context* ctx);
// Pushes a buffer of zeros and returns its data.
void* duk_push_fixed_buffer(duk_context* ctx, duk_size_t bytes);
void* duk_push_dynamic_buffer(duk_context* ctx, duk_size_t bytes);
void* duk_resize_buffer(duk_context* ctx, duk_idx_t index, duk_size_t bytes);
void* duk_get_buffer(duk_context* ctx, duk_idx_t index, duk_size_t* bytes);

// --- convert.cpp ---
void duk_push_string(duk_context* ctx, const char* text);
void duk_push_lstring(duk_context* ctx, const char* text, duk_size_t bytes);
const char* duk_push_sprintf(duk_context* ctx, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
const char* duk_get_string(duk_context* ctx, duk_idx_t index); // null: no string
const char* duk_get_lstring(duk_context* ctx, duk_idx_t index, duk_size_t* bytes);
const char* duk_to_string(duk_context* ctx, duk_idx_t index);
const char* duk_safe_to_string(duk_context* ctx, duk_idx_t index);
void duk_concat(duk_context* ctx, duk_idx_t count);
void duk_join(duk_context* ctx, duk_idx_t count); // stack: separator, texts
double duk_to_number(duk_context* ctx, duk_idx_t index);
int32_t duk_to_int32(duk_context* ctx, duk_idx_t index);
void duk_to_primitive(duk_context* ctx, duk_idx_t index, int hint);
bool duk_get_boolean(duk_context* ctx, duk_idx_t index);
double duk_get_number(duk_context* ctx, duk_idx_t index);
unsigned duk_get_uint_default(duk_context* ctx, duk_idx_t index, unsigned otherwise);
bool duk_is_undefined(duk_context* ctx, duk_idx_t index);
bool duk_is_null(duk_context* ctx, duk_idx_t index);
bool duk_is_null_or_undefined(duk_context* ctx, duk_idx_t index);
bool duk_is_boolean(duk_context* ctx, duk_idx_t index);
bool duk_is_number(duk_context* ctx, duk_idx_t index);
bool duk_is_string(duk_context* ctx, duk_idx_t index);
bool duk_is_object(duk_context* ctx, duk_idx_t index);
bool duk_is_array(duk_context* ctx, duk_idx_t index);
bool duk_is_function(duk_context* ctx, duk_idx_t index);
bool duk_is_callable(duk_context* ctx, duk_idx_t index);
bool duk_is_error(duk_context* ctx, duk_idx_t index);
bool duk_is_buffer_data(duk_context* ctx, duk_idx_t index); // typed arrays

// --- properties.cpp ---
bool duk_get_prop(duk_context* ctx, duk_idx_t object);
bool duk_get_prop_index(duk_context* ctx, duk_idx_t object, duk_uarridx_t at);
bool duk_get_prop_string(duk_context* ctx, duk_idx_t object, const char* key);
bool duk_get_prop_heapptr(duk_context* ctx, duk_idx_t object, void* key);
void duk_put_prop(duk_context* ctx, duk_idx_t object);
void duk_put_prop_index(duk_context* ctx, duk_idx_t object, duk_uarridx_t at);
void duk_put_prop_string(duk_context* ctx, duk_idx_t object, const char* key);
void duk_put_prop_heapptr(duk_context* ctx, duk_idx_t object, void* key);
bool duk_has_prop(duk_context* ctx, duk_idx_t object);
bool duk_has_prop_string(duk_context* ctx, duk_idx_t object, const char* key);
void duk_del_prop(duk_context* ctx, duk_idx_t object);
void duk_del_prop_string(duk_context* ctx, duk_idx_t object, const char* key);
void duk_def_prop(duk_context* ctx, duk_idx_t object, unsigned flags);
// Pushes the global property or, if there is none, what `let`, `const` or `class` declares.
bool duk_get_global_string(duk_context* ctx, const char* key);
void duk_put_global_string(duk_context* ctx, const char* key);
duk_size_t duk_get_length(duk_context* ctx, duk_idx_t object);
void duk_set_length(duk_context* ctx, duk_idx_t object, duk_size_t length);
bool duk_instanceof(duk_context* ctx, duk_idx_t object, duk_idx_t constructor);

// --- objects.cpp ---
duk_idx_t duk_push_object(duk_context* ctx);
duk_idx_t duk_push_bare_object(duk_context* ctx);
void duk_push_proxy(duk_context* ctx, unsigned flags); // stack: target, traps
void duk_get_prototype(duk_context* ctx, duk_idx_t object);
// Sets the prototype; the object also gets the finalizer of the prototype.
void duk_set_prototype(duk_context* ctx, duk_idx_t object);
void duk_set_finalizer(duk_context* ctx, duk_idx_t object);
