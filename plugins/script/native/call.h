// call.h: one C function, called with values of VRML's types: its frame by libffi, made once; its
// memory. [the browser's thread]
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include <ffi.h>

#include "program.h"
#include "slots.h"

namespace native {

// A value that goes into libffi, or comes out of it.
union Cell {
  int64_t i;
  uint64_t u;
  float f;
  double d;
  void* p;
  ffi_arg returned; // small results are widened to this
};

class PreparedCall {
 public:
  // What the function finds, and where its results go. The functions answer as the host does.
  struct World {
    const XsHost* host;
    XsNode self;
    double time;
    std::function<Slot&(uint32_t field)> input; // its value now
    std::function<XsResult(uint32_t field, const XsValue& value)>
        give; // sends an eventOut, writes a field
    std::function<void(int32_t severity, uint32_t line, std::string what)> log;
  };

  PreparedCall(const Call& call, void* function, const XsScriptInfo& info); // throws ProgramError
  // Calls it. XS_FAILED (after logging): it wrote more than there is room for, or the host refused
  // a value.
  XsResult run(const World& world);
  const Call& call() const { return call_; }

 private:
  struct Place { // what the function writes to
    uint32_t field;
    Slot slot;
    Number number = Number::none;
    Cell cell{}; // a number in another type than VRML's
    uint32_t room = 0;
    uint32_t count = 0; // of an MF type: in: room, out: elements
    bool fixed = true;  // the function does not say how many elements it wrote
  };
  Place& place(const Argument& argument);
  void add(const Argument& argument);
  void push(ffi_type* type, std::function<void(const World&, Cell&)> fill);
  XsResult giveAll(const World& world, const Cell& result);
  XsResult give(const World& world, uint32_t field, const XsValue& value);

  Call call_;
  void (*function_)();
  const XsScriptInfo& info_;
  std::vector<ffi_type*> types_;
  std::vector<std::function<void(const World&, Cell&)>> fill_;
  std::vector<Cell> cells_;
  std::deque<Place> places_; // do not move: the function gets their addresses
  ffi_cif frame_{};
};

} // namespace native
