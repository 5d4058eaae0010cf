// interpreter.cpp: Creates the heap of a Script, runs its program and calls its functions. Every
// entry is protected: an error of the program, missing memory and even a fatal error of the engine
// produce a message and XS_FAILED.
#include "interpreter.h"

#include <cstdlib>
#include <cstring>
#include <new>

#include "assignments.h"
#include "slots.h"

namespace ecma {

// A block of the heap's memory. All blocks are in a list, so that a heap can be freed after a fatal
// error of the engine.
struct alignas(16) Block { // the memory after the header has malloc's alignment
  Block *before, *after;
  duk_size_t bytes;
};

namespace {

// --- Memory ---

Block* blockOf(void* memory) { return static_cast<Block*>(memory) - 1; }

bool fits(const Interpreter& self, uint64_t more) {
  return self.most == 0 || (more <= self.most && self.used <= self.most - more);
}

// Makes the neighbours in the list point to the block.
void* link(Interpreter& self, Block* block) {
  (block->before ? block->before->after : self.blocks) = block;
  if (block->after) block->after->before = block;
  return block + 1;
}

void* allocate(void* account, duk_size_t bytes) {
  Interpreter& self = *static_cast<Interpreter*>(account);
  if (bytes == 0 || bytes > SIZE_MAX - sizeof(Block) || !fits(self, bytes)) return nullptr;
  auto* block = static_cast<Block*>(std::malloc(bytes + sizeof(Block)));
  if (!block) return nullptr;
  *block = {nullptr, self.blocks, bytes};
  self.used += bytes;
  return link(self, block);
}

void release(void* account, void* memory) {
  if (!memory) return;
  Interpreter& self = *static_cast<Interpreter*>(account);
  Block* block = blockOf(memory);
  (block->before ? block->before->after : self.blocks) = block->after;
  if (block->after) block->after->before = block->before;
  self.used -= block->bytes;
  std::free(block);
}

void* reallocate(void* account, void* memory, duk_size_t bytes) {
  if (!memory) return allocate(account, bytes);
  if (bytes == 0) {
    release(account, memory);
    return nullptr;
  }
  Interpreter& self = *static_cast<Interpreter*>(account);
  const duk_size_t old = blockOf(memory)->bytes;
  if (bytes > SIZE_MAX - sizeof(Block) || (bytes > old && !fits(self, bytes - old))) return nullptr;
  auto* block = static_cast<Block*>(std::realloc(blockOf(memory), bytes + sizeof(Block)));
  if (!block) return nullptr;
  block->bytes = bytes;
  self.used += bytes - old;
  return link(self, block);
}

// Frees all blocks of the heap without calling the engine.
void freeHeap(Interpreter& self) {
  while (self.blocks) release(&self, self.blocks + 1);
}

// Called for a fatal error of the engine. It must not return; every entry has set the jump target.
void onFatalError(void* account, const char* message) {
  Interpreter& self = *static_cast<Interpreter*>(account);
  self.dead = true;
  logText(self, 3, 0, message ? message : "the engine has given up",
          message ? std::strlen(message) : 23);
  if (self.fatalSet) std::longjmp(self.fatal, 1);
  for (;;) {} // unreachable: the engine is called only inside an entry
}

// --- Protected entries ---

// Runs a function in a protected call and reports its error.
bool guarded(Interpreter& self, duk_safe_call_function function, void* data, const char* during) {
  duk_context* ctx = self.ctx;
  if (duk_safe_call(ctx, function, data, 0, 1) == DUK_EXEC_SUCCESS) {
    duk_pop(ctx);
    return true;
  }
  if (!self.stopped) {
    const auto report = [](duk_context* c, void* text) -> duk_ret_t {
      reportError(Interpreter::of(c), static_cast<const char*>(text));
      return 0;
    };
    if (duk_safe_call(ctx, report, const_cast<char*>(during), 1, 1) != DUK_EXEC_SUCCESS)
      logText(self, 3, 0, "out of memory", 13);
  }
  duk_pop(ctx);
  return false;
}

XsResult enter(Interpreter& self, duk_safe_call_function function, void* data, const char* during,
               bool flush) {
  if (self.dead || self.stopped) return XS_OK; // the program has ended; not even shutdown runs
  ++self.call;
  self.texts.clear();
  if (setjmp(self.fatal)) {
    self.fatalSet = false;
    return XS_FAILED;
  }
  self.fatalSet = true;
  bool good = guarded(self, function, data, during);
  if (!self.stopped && flush) good = guarded(self, flushSlots, &self, "sending events") && good;
  self.fatalSet = false;
  return self.stopped ? XS_STOPPED : good ? XS_OK : XS_FAILED;
}

void* makeKey(duk_context* ctx, const char* name) {
  duk_push_string(ctx, name);
  return keep(ctx);
}

duk_ret_t setUp(duk_context* ctx, void* data) {
  Interpreter& self = *static_cast<Interpreter*>(data);
  self.keySf = makeKey(ctx, DUK_HIDDEN_SYMBOL("sf"));
  self.keyMf = makeKey(ctx, DUK_HIDDEN_SYMBOL("mf"));
  self.keyList = makeKey(ctx, DUK_HIDDEN_SYMBOL("list"));
  self.keyParent = makeKey(ctx, DUK_HIDDEN_SYMBOL("parent"));
  self.keyNode = makeKey(ctx, DUK_HIDDEN_SYMBOL("node"));
  self.keyMatrix = makeKey(ctx, DUK_HIDDEN_SYMBOL("matrix"));
  self.keyRow = makeKey(ctx, DUK_HIDDEN_SYMBOL("row"));
  duk_push_array(ctx);
  self.values = keep(ctx);
  duk_push_array(ctx);
  self.held = keep(ctx);
  duk_push_bare_object(ctx);
  self.types = keep(ctx);
  registerSf(ctx, self);
  registerMf(ctx, self);
  registerMatrix(ctx, self);
  registerNodes(ctx, self);
  registerBrowser(ctx, self);
  registerConstants(ctx);
  registerFields(ctx, self);
  restrictGlobals(ctx, self);
  return 0;
}

// Inserts the copies that C.6.2 requires. If the result does not compile although the original
// does, the text was misunderstood, and runProgram() uses the original. Returns false if there is
// no memory.
bool prepareProgram(Interpreter& self) noexcept {
  try {
    const XsString text = self.info->text;
    std::string_view program(text.data ? text.data : "", text.bytes);
    if (program.starts_with("\xef\xbb\xbf")) program.remove_prefix(3);
    std::unordered_set<std::string_view> objects;
    for (uint32_t i = 0; i < self.info->fieldCount; ++i) {
      const XsField& field = self.info->fields[i];
      const bool object =
          isMf(field.type) || field.type == XS_SFIMAGE || components(field.type) > 1;
      if (field.access != XS_EVENT_IN && object) objects.insert(field.name);
    }
    self.program = copyAssigned(program, objects);
    return true;
  } catch (const std::bad_alloc&) { return false; }
}

duk_ret_t runProgram(duk_context* ctx, void* data) {
  Interpreter& self = *static_cast<Interpreter*>(data);
  const XsString text = self.info->text;
  duk_push_lstring(ctx, self.program.data(), self.program.size());
  duk_push_string(ctx, "script");
  if (self.program.empty() || duk_pcompile(ctx, 0) != 0) {
    const bool marked = text.bytes >= 3 && std::memcmp(text.data, "\xef\xbb\xbf", 3) == 0;
    duk_push_lstring(ctx, text.data + (marked ? 3 : 0), text.bytes - (marked ? 3 : 0));
    duk_push_string(ctx, "script");
    duk_compile(ctx, 0);
  }
  duk_call(ctx, 0);
  return 0;
}

struct Call {
  Interpreter& self;
  const char* name;
  const char* otherName; // tried if there is no function `name`; null: none
  const XsValue* value;
  double time;
};

duk_ret_t runCall(duk_context* ctx, void* data) {
  const Call& call = *static_cast<Call*>(data);
  duk_get_global_string(ctx, call.name);
  if (!duk_is_callable(ctx, -1)) {
    if (!call.otherName) return 0;
    duk_get_global_string(ctx, call.otherName);
    if (!duk_is_callable(ctx, -1)) return 0;
  }
  if (call.value) {
    pushValue(ctx, call.self, *call.value);
    duk_push_number(ctx, call.time);
  }
  duk_call(ctx, call.value ? 2 : 0);
  return 0;
}

} // namespace

Interpreter::~Interpreter() {
  for (const auto& [number, record] : nodes) delete record;
}

Interpreter& Interpreter::of(duk_context* ctx) {
  duk_memory_functions functions;
  duk_get_memory_functions(ctx, &functions);
  return *static_cast<Interpreter*>(functions.udata);
}

void* keep(duk_context* ctx) {
  void* pointer = duk_get_heapptr(ctx, -1);
  duk_push_global_stash(ctx);
  duk_get_prop_string(ctx, -1, "kept");
  const duk_uarridx_t count = duk_get_uint_default(ctx, -1, 0);
  duk_pop(ctx);
  duk_dup(ctx, -2);
  duk_put_prop_index(ctx, -2, count);
  duk_push_uint(ctx, count + 1);
  duk_put_prop_string(ctx, -2, "kept");
  duk_pop_2(ctx);
  return pointer;
}

Interpreter* createInterpreter(const XsHost* host, const XsScriptInfo* info, XsResult& result) {
  result = XS_FAILED;
  // const, so that it is still valid after a longjmp
  Interpreter* const self = new (std::nothrow) Interpreter;
  if (!self) return nullptr;
  self->host = host;
  self->info = info;
  self->self = info->self;
  self->most = info->memory;
  if (setjmp(self->fatal)) {
    freeHeap(*self); // only partly constructed
    delete self;
    return nullptr;
  }
  self->fatalSet = true;
  self->ctx = duk_create_heap(allocate, reallocate, release, self, onFatalError);
  self->fatalSet = false;
  if (!self->ctx) {
    logText(*self, 3, 0, "no memory for an interpreter", 28);
    freeHeap(*self); // what a failed creation has left
    delete self;
    return nullptr;
  }
  result = enter(*self, setUp, self, "setting up", false);
  if (result == XS_OK && !prepareProgram(*self)) {
    logText(*self, 3, 0, "no memory for the program", 25);
    result = XS_FAILED;
  }
  if (result == XS_OK) result = enter(*self, runProgram, self, "running the program", true);
  self->program = {};
  if (result == XS_OK) return self;
  destroyInterpreter(self);
  return nullptr;
}

void destroyInterpreter(Interpreter* self) {
  if (!self->dead) {
    self->ending = true;
    if (setjmp(self->fatal) == 0) {
      self->fatalSet = true;
      duk_destroy_heap(self->ctx);
    }
  }
  freeHeap(*self); // what remains after a fatal error, and all of QuickJS
  delete self;
}

XsResult callFunction(Interpreter& self, const char* name, const XsValue* value, double time,
                      bool shutdown) {
  Call call{self, name, nullptr, value, time};
  return enter(self, runCall, &call, name, !shutdown);
}

// An inputOutput field x of X3D calls set_x, because x is the variable with its value. A program
// that declares a function x has no such variable.
XsResult receiveEvent(Interpreter& self, const XsEvent& event) {
  if (self.info->fields[event.index].access != XS_EXPOSED_FIELD)
    return callFunction(self, event.name, &event.value, event.time);
  renewOwn(self, event.name);
  try {
    const std::string function = std::string("set_") + event.name;
    Call call{self, function.c_str(), event.name, &event.value, event.time};
    return enter(self, runCall, &call, function.c_str(), true);
  } catch (const std::bad_alloc&) { return XS_FAILED; }
}

bool mustStop(Interpreter& self, uint64_t steps) {
  self.stopped = self.stopped || self.host->shouldStop(self.host, self.self, steps);
  return self.stopped;
}

void step(Interpreter& self) {
  constexpr uint32_t often = 256;
  if (++self.nativeCalls < often && !self.stopped) return;
  const bool stops = mustStop(self, self.nativeCalls);
  self.nativeCalls = 0;
  if (stops) throwRange(self.ctx, "the Script is stopped");
}

} // namespace ecma
