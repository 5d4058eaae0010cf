// interpreter.h: one Script's interpreter: a Duktape heap with a cap on its memory, the Script's
// fields and those of the nodes it uses ("slots"), and the nodes it holds. Every function of the
// engine has it as its context. [the browser's thread]
//
// Duktape reports errors by longjmp: no function that calls it may own anything that needs a
// destructor. What must outlive a call of it lies in the Duktape heap or in members here.
#pragma once

#include <csetjmp>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include <duktape.h>
#include <xvrml/xscript.h>

namespace ecma {

// A field or event of the Script or of a node it uses, and the value the program sees there. Own
// ones are kept from call to call: nobody else writes them. Those of other nodes are read again in
// each call of the host.
struct Slot {
  XsNode node = 0; // 0: the Script's own
  std::string name;
  XsType type{};
  XsAccess access{};
  bool readable = false, writable = false;
  bool dirty = false; // to be sent, posted or written when the function returns
  uint32_t serial =
      0; // another one once the place is used again: objects that still name the old one are free
  uint64_t call = 0; // in which the value was read; own: 1 once it was
  double plain[4] =
      {}; // SFBool, SFInt32, SFFloat, SFTime, tuples; else the value is in the array `values`
};

struct NodeRecord {
  XsNode node = 0;
  void* object = nullptr;                 // its wrapper, which the finalizer takes away
  std::vector<std::pair<int, int>> slots; // index of the name, slot
};

struct Block;

struct Interpreter {
  // Before all else: the allocator's account.
  uint64_t used = 0, most = 0;
  Block* blocks = nullptr; // all of the heap

  const XsHost* host = nullptr;
  const XsScriptInfo* info = nullptr;
  XsNode self = 0;
  duk_context* ctx = nullptr;
  bool stopped = false; // the host said so: nothing of the program may run any more
  bool ending = false;  // the heap is being destroyed
  bool dead = false;    // Duktape has given up; the heap is freed without it
  uint64_t call = 1;    // number of the host's call
  uint32_t natives = 0; // calls of native functions since the host was asked
  uint64_t random = 0;  // state of Math.random

  // Hidden property keys, and objects that the stash holds.
  void *keySf = nullptr, *keyMf = nullptr, *keyList = nullptr, *keyParent = nullptr,
       *keyNode = nullptr, *keyMatrix = nullptr, *keyRow = nullptr;
  void *values = nullptr, *held = nullptr, *types = nullptr, *mfHandler = nullptr,
       *nodePrototype = nullptr, *matrixPrototype = nullptr, *rowPrototype = nullptr;
  void* prototypes[XS_MFVEC3F + 1] = {};
  void *componentGet[4] = {}, *componentSet[4] = {};

  std::deque<Slot> slots; // they stay where they are
  std::vector<int> freeSlots, dirty;
  uint32_t nextSerial = 0;
  std::unordered_map<XsNode, NodeRecord*> nodes;
  std::vector<std::string> names; // of fields of nodes: what accessors know by number

  // What a value for the host points to while it is handed over.
  std::vector<float> floats;
  std::vector<XsString> strings;
  std::vector<XsNode> handles;
  std::deque<std::string> texts; // converted ones, of this call
  std::vector<uint8_t> pixels;
  std::string program; // as it is compiled
  int32_t integer = 0;
  XsImage image{};

  std::jmp_buf fatal;
  bool fatalSet = false;

  ~Interpreter();
  static Interpreter& of(duk_context* ctx);
};

// interpreter.cpp
Interpreter* createInterpreter(const XsHost* host, const XsScriptInfo* info, XsResult& result);
void destroyInterpreter(Interpreter* interpreter);
// Calls the global function of this name, if there is one, with the event's value, or with nothing;
// sends what it has assigned.
XsResult callFunction(Interpreter& self, const char* name, const XsValue* value, double time,
                      bool shutdown = false);

// At the start of every native function: asks the host now and then; does not return once the
// Script is stopped.
void step(Interpreter& self);

// errors.cpp: says what the error on top of the stack is, with the program's line and the function.
void reportError(Interpreter& self, const char* during);
void logText(Interpreter& self, int severity, uint32_t line, const char* text, size_t bytes);
[[noreturn]] void throwType(duk_context* ctx, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
[[noreturn]] void throwRange(duk_context* ctx, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
// The host has refused something: an error with its reason; does not return.
[[noreturn]] void throwHost(duk_context* ctx, Interpreter& self, XsResult result, const char* what);

// sandbox.cpp: takes away what is not ECMAScript; random numbers and dates that replay.
void restrictGlobals(duk_context* ctx, Interpreter& self);

// An array or object that lives as long as the heap; the pointer to it.
void* keep(duk_context* ctx); // pops it

} // namespace ecma
