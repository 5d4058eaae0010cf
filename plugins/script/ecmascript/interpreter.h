// interpreter.h: Owns the interpreter of one Script: a heap with limited memory, the fields of the
// Script and of the nodes it uses ("slots"), and the nodes it holds. Every function of the engine
// has it as its context. [the browser's thread]
//
// The objects of Annex C are written for Duktape's stack API. It comes from Duktape, or from
// quickjs/ (quickjs/language.h). Errors are reported with longjmp, so a function that calls the API
// must not own anything with a destructor. Data that must survive a call belongs in the heap or in
// members here.
#pragma once

#include <csetjmp>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include <xvrml/xscript_types.h>

#include "language.h"

namespace ecma {

// A field or event of the Script, or of a node it uses, with the value that the program sees. The
// Script's own values are kept between calls, because nobody else writes them. Values of other
// nodes are read again in each call of the host.
struct Slot {
  XsNode node = 0; // 0: the Script itself
  std::string name;
  XsType type{};
  XsAccess access{};
  bool readable = false, writable = false;
  bool dirty = false; // send, post or write the value when the function returns
  // Changes when the slot is reused; objects with an old serial are detached.
  uint32_t serial = 0;
  // The host call in which the value was read; the Script's own slots have 1 after that.
  uint64_t call = 0;
  // Value of SFBool, SFInt32, SFFloat, SFTime and tuples; other values are in the array `values`.
  double plain[XS_MOST_COMPONENTS] = {};
};

struct NodeRecord {
  XsNode node = 0;
  void* object = nullptr;                 // the wrapper object; its finalizer clears this
  std::vector<std::pair<int, int>> slots; // index of the name, slot
};

struct Block;

struct Interpreter {
  // Must come first: the allocator's counters.
  uint64_t used = 0, most = 0;
  Block* blocks = nullptr; // list of all blocks of the heap

  const XsHost* host = nullptr;
  const XsScriptInfo* info = nullptr;
  XsNode self = 0;
  duk_context* ctx = nullptr;
  bool stopped = false;     // the host has stopped the program; it must not run any more
  bool ending = false;      // the heap is being destroyed
  bool dead = false;        // the language had a fatal error; the heap is freed without it
  uint64_t call = 1;        // number of the current call by the host
  uint32_t nativeCalls = 0; // calls of native functions since shouldStop was last called
  uint64_t random = 0;      // state of Math.random

  // Hidden property keys, and objects that the stash keeps alive.
  void *keySf = nullptr, *keyMf = nullptr, *keyList = nullptr, *keyParent = nullptr,
       *keyNode = nullptr, *keyMatrix = nullptr, *keyRow = nullptr;
  void *values = nullptr, *held = nullptr, *types = nullptr, *mfHandler = nullptr,
       *nodePrototype = nullptr, *matrixPrototype = nullptr, *rowPrototype = nullptr,
       *scenePrototype = nullptr;
  void* prototypes[XS_LAST_TYPE + 1] = {};
  void *componentGet[XS_MOST_COMPONENTS] = {}, *componentSet[XS_MOST_COMPONENTS] = {};

  std::deque<Slot> slots; // a deque, because references to slots must stay valid
  std::vector<int> freeSlots, dirty;
  uint32_t nextSerial = 0;
  std::unordered_map<XsNode, NodeRecord*> nodes;
  std::vector<std::string> names; // names of the nodes' fields; accessors refer to them by index

  // Storage that a value for the host points to during a call.
  std::vector<float> floats;
  std::vector<XsString> strings;
  std::vector<XsNode> handles;
  std::deque<std::string> texts;           // strings converted during this call
  std::deque<std::vector<uint8_t>> pixels; // the pixels of each image
  std::vector<XsImage> images;
  std::string program; // the program as compiled
  int32_t integer = 0;

  std::jmp_buf fatal;
  bool fatalSet = false;

  ~Interpreter();
  static Interpreter& of(duk_context* ctx);
};

// --- interpreter.cpp ---
Interpreter* createInterpreter(const XsHost* host, const XsScriptInfo* info, XsResult& result);
void destroyInterpreter(Interpreter* interpreter);
// Calls the global function of this name, if it exists, with the event's value or without
// arguments, and then sends what it has assigned.
XsResult callFunction(Interpreter& self, const char* name, const XsValue* value, double time,
                      bool shutdown = false);
// Delivers an event: calls the function of the eventIn's name, or set_x for an inputOutput field x.
XsResult receiveEvent(Interpreter& self, const XsEvent& event);

// Tells the host that the program has taken steps. Returns whether the Script is stopped.
bool mustStop(Interpreter& self, uint64_t steps);
// Called at the start of every native function: asks the host now and then. Does not return when
// the Script is stopped.
void step(Interpreter& self);

// Replaces a syntax error on top of the stack by one that says more, if there is more to say.
// Returns its line; 0: the error stays. Each engine has its own.
uint32_t explainSyntax(duk_context* ctx, const Interpreter& self);
// errors.cpp: says what the error on top of the stack is, with the program's line and the function.
void reportError(Interpreter& self, const char* during);
void logText(Interpreter& self, int severity, uint32_t line, const char* text, size_t bytes);
[[noreturn]] void throwType(duk_context* ctx, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
[[noreturn]] void throwRange(duk_context* ctx, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
// Throws an error with the host's reason for a refusal; does not return.
[[noreturn]] void throwHost(duk_context* ctx, Interpreter& self, XsResult result, const char* what);

// sandbox.cpp: Removes everything that is not ECMAScript, and makes random numbers and dates
// repeatable.
void restrictGlobals(duk_context* ctx, Interpreter& self);

// Keeps the array or object on top alive as long as the heap, and returns a pointer to it.
void* keep(duk_context* ctx); // pops it

} // namespace ecma
