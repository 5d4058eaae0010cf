// stack.h: Holds the state behind language.h: a QuickJS context, the stack of values, and the
// frames of native functions. [the browser's thread]
#pragma once

#include <csetjmp>

#include <quickjs/quickjs.h>

#include "language.h"

namespace ecma {

// Bytes that a native function has on the stack or in a hidden property. Not an object of QuickJS,
// because the collector may finalize such an object before the one that refers to it.
struct Buffer {
  size_t uses, bytes;
  bool separate; // data is a block of its own
  void* data;
};

// A value of the stack, or of a hidden property. It owns one use of the value and of the buffer.
struct Entry {
  JSValue value;
  Buffer* buffer; // null: the value counts
};

// The hidden properties of an object. Keys are interned names (hiddenName).
struct Hidden {
  duk_c_function finalizer;
  uint32_t count, capacity;
  struct Property {
    const void* key;
    Entry entry;
  } * properties;
};

// A native function of the stack API.
struct Native {
  duk_c_function function;
  int16_t arguments, magic;
};

// One native function, or protected call, that is running.
struct Frame {
  Frame* outer;
  size_t base;  // its entries of the stack begin here
  size_t texts; // its texts begin here
  JSValueConst self;
  int magic;
  bool finalizes; // the object in its first entry has lost its shape already
  std::jmp_buf target;
};

enum Trap : uint8_t { trapGet, trapSet, trapHas, trapDelete, trapCount };
// A program may use so much of the thread's stack, the same on every machine.
constexpr size_t stackBytes = 1 << 20;
constexpr size_t mostNames = 16, typedArrays = 9;

} // namespace ecma

struct ScriptStack {
  duk_memory_functions memory;
  duk_fatal_function fatal;
  JSRuntime* runtime;
  JSContext* js;

  ecma::Entry* entries;
  size_t top, capacity;
  const char** texts; // C strings, freed at the end of the frame
  size_t textCount, textCapacity;
  ecma::Frame bottom;
  ecma::Frame* frame;

  ecma::Buffer* names[ecma::mostNames]; // hidden keys
  void* traps;                          // the object with the functions below
  JSValue trap[ecma::trapCount];
  JSValue stash, functionPrototype, objectPrototype, typeError, rangeError;
  JSValue lexical;  // functions that read what `let` and its like declare, by name
  JSValue rejected; // an Array of promises that were rejected, and reasons
  JSClassID objectClass, listClass, functionClass, proxyClass, arrayClasses[ecma::typedArrays];
  bool stopped;       // by the host; the program's jobs do not run any more
  uintptr_t stackTop; // address where the call of the host began
  uint64_t collected; // memory in use after a collection near the limit
};

namespace ecma {

// Leaves the innermost frame; an exception is pending in QuickJS.
[[noreturn]] void fail(ScriptStack* s);
[[noreturn]] void failMemory(ScriptStack* s);
inline void check(ScriptStack* s, int result) {
  if (result < 0) fail(s);
}

// --- stack.cpp ---
bool reserve(ScriptStack* s); // makes room for more entries
// Pushes a value and takes over its use. An exception fails.
void push(ScriptStack* s, JSValue value);
void pushEntry(ScriptStack* s, Entry entry);
Entry takeTop(ScriptStack* s);
void freeEntry(ScriptStack* s, Entry entry);
void truncate(ScriptStack* s, size_t top);
// Returns the place in `entries`, which may be beyond the top.
size_t placeOf(const ScriptStack* s, duk_idx_t index);
// Returns the value without its use; undefined: there is none.
JSValueConst valueAt(const ScriptStack* s, duk_idx_t index);
// Returns the key of a hidden property of this name.
Buffer* hiddenName(ScriptStack* s, const char* name);
inline bool isHiddenName(const char* text) { return *text == '\xff'; }
inline JSValue objectAt(void* pointer) { return JS_MKPTR(JS_TAG_OBJECT, pointer); }
void freeBuffer(JSRuntime* runtime, Buffer* buffer);

// --- convert.cpp ---
// Returns the text of a string, which is valid until the frame ends.
const char* textOf(ScriptStack* s, JSValueConst string, size_t* bytes);
void freeTexts(ScriptStack* s, size_t from);

// --- calls.cpp ---
using Work = int (*)(ScriptStack* s, void* data);
// Runs work in a frame. Returns its result; -1 if it has failed and an exception is pending.
int runProtected(ScriptStack* s, Frame& frame, Work work, void* data);
void enterFrame(ScriptStack* s, Frame& frame, JSValueConst self, int magic);
// Frees what the frame has left on the stack above `top`, and its texts.
void leaveFrame(ScriptStack* s, const Frame& frame, size_t top);
// Makes the class of native functions; returns a negative number if there is no memory.
int registerFunctions(ScriptStack* s);
// Returns the function of a native one; null: the value is none.
const Native* nativeAt(const ScriptStack* s, JSValueConst function);

// --- jobs.cpp ---
void watchJobs(ScriptStack* s);
// Runs the jobs of promises. Returns the error of a job, or a rejection that nobody handles.
bool runJobs(ScriptStack* s, JSValue& error);

// --- objects.cpp ---
int registerObjects(ScriptStack* s);
// Returns the hidden property, also an inherited one; null: there is none.
const Entry* findHidden(ScriptStack* s, JSValueConst object, const void* key);
// Takes the entry over. Throws if the object cannot have hidden properties.
void setHidden(ScriptStack* s, JSValueConst object, const void* key, Entry entry);
// Makes the object inherit from another prototype, unless it is one with a finalizer.
int derive(ScriptStack* s, JSValueConst object, JSValueConst prototype);

} // namespace ecma
