// call.h: Calls one C function with values of VRML's types: owns its libffi call frame, prepared
// once, and its memory. [the browser's thread]
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include <ffi.h>

#include "program.h"
#include "slots.h"

namespace native {

// A value that is passed to or returned from libffi.
union Cell {
  int64_t i;
  uint64_t u;
  float f;
  double d;
  void* p;
  ffi_arg returned; // libffi widens small results to this type
};

class PreparedCall {
 public:
  // Connects the function to its Script: the sources of arguments and the destinations of results.
  // The callbacks return the host's results.
  struct World {
    const XsHost* host;
    XsNode self;
    double time;
    std::function<Slot&(uint32_t field)> input; // returns the current value
    // Sends an eventOut or writes a field.
    std::function<XsResult(uint32_t field, const XsValue& value)> give;
    std::function<void(int32_t severity, uint32_t line, std::string what)> log;
  };

  PreparedCall(const Call& call, void* function, const XsScriptInfo& info); // throws ProgramError
  // Calls the function. Returns XS_FAILED, after logging, if the function wrote more than there is
  // room for, or if the host refused a value.
  XsResult run(const World& world);
  const Call& call() const { return call_; }

 private:
  struct Place { // memory that the function writes to
    uint32_t field;
    Slot slot;
    Number number = Number::none;
    Cell cell{}; // a number whose C type differs from VRML's
    uint32_t room = 0;
    uint32_t count = 0; // for MF types: room on input, number of elements on output
    bool fixed = true;  // the function does not report how many elements it wrote
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
  std::deque<Place> places_; // a deque, because the function gets addresses of the elements
  ffi_cif frame_{};
};

} // namespace native
