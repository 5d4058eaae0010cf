// sandbox.cpp: Removes from the global object everything that is not ECMAScript and could reach
// the engine's internals. Dates follow the world's time, and random numbers the program's text, so
// that a replayed world does the same.
#include "slots.h"

namespace ecma {
namespace {

// xorshift64* (S. Vigna, "An experimental exploration of Marsaglia's xorshift generators,
// scrambled", 2016).
duk_ret_t random(duk_context* ctx) {
  uint64_t& x = Interpreter::of(ctx).random;
  x ^= x >> 12;
  x ^= x << 25;
  x ^= x >> 27;
  duk_push_number(ctx, double((x * 0x2545f4914f6cdd1dULL) >> 11) * 0x1p-53);
  return 1;
}

duk_ret_t now(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  duk_push_number(ctx, self.host->now(self.host, self.self) * 1000);
  return 1;
}

// Replaces Date; without arguments it returns the world's time. Only this closure can reach the
// original.
const char* const dates =
    "(function(D,now){function Date(y,m,d,h,i,s,n){"
    "if(!(this instanceof Date))return new D(now()).toString();"
    "switch(arguments.length){case 0:return new D(now());case 1:return new D(y);"
    "default:return new D(y,m,d===undefined?1:d,h||0,i||0,s||0,n||0)}}"
    "Date.prototype=D.prototype;Date.parse=D.parse;Date.UTC=D.UTC;Date.now=now;"
    "Object.defineProperty(D.prototype,'constructor',{value:Date,writable:true,configurable:true});"
    "return Date})";

void removeProperty(duk_context* ctx, const char* object, const char* name) {
  duk_push_global_object(ctx);
  if (object) duk_get_prop_string(ctx, -1, object);
  if (duk_is_object(ctx, -1)) duk_del_prop_string(ctx, -1, name);
  duk_pop_n(ctx, object ? 2 : 1);
}

} // namespace

void restrictGlobals(duk_context* ctx, Interpreter& self) {
  // Remove finalizers, threads and raw pointers, and functions that make strings of arbitrary
  // bytes, because such strings could be hidden keys.
  removeProperty(ctx, nullptr, "Duktape");
  removeProperty(ctx, nullptr, "CBOR");
  removeProperty(ctx, nullptr, "Buffer");
  removeProperty(ctx, "String", "fromBufferRaw");
  removeProperty(ctx, "Uint8Array", "allocPlain");
  removeProperty(ctx, "Uint8Array", "plainOf");
  removeProperty(ctx, nullptr, "performance");
  // Remove what makes threads wait for each other.
  removeProperty(ctx, nullptr, "Atomics");
  removeProperty(ctx, nullptr, "SharedArrayBuffer");
  duk_get_global_string(ctx, "Math");
  duk_push_c_function(ctx, random, 0);
  duk_put_prop_string(ctx, -2, "random");
  duk_pop(ctx);
  uint64_t seed = 0xcbf29ce484222325ULL ^ self.self; // FNV-1a hash of the program
  for (uint64_t i = 0; i < self.info->text.bytes; ++i)
    seed = (seed ^ static_cast<unsigned char>(self.info->text.data[i])) * 0x100000001b3ULL;
  self.random = seed ? seed : 1;
  duk_eval_string(ctx, dates);
  duk_get_global_string(ctx, "Date");
  duk_push_c_function(ctx, now, 0);
  duk_call(ctx, 2);
  duk_put_global_string(ctx, "Date");
}

} // namespace ecma
