// program.h: what stands behind native: in a Script's url, read into a list of calls. A pure
// function of the text, the Script's declarations and the names that the library exports. [the
// browser's thread]
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <xvrml/xscript.h>

namespace native {

// What is wrong, and in which line of the program.
struct ProgramError : std::runtime_error {
  ProgramError(uint32_t line, const std::string& what) : std::runtime_error(what), line(line) {}
  uint32_t line;
};

// A number's type in C, where it is not the one that belongs to the VRML type.
enum class Number : uint8_t { none, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

struct Argument {
  enum class Kind : uint8_t { field, integer, real, host, self, time } kind = Kind::field;
  enum class Part : uint8_t { whole, data, count } part = Part::whole; // x, x.data, x.count
  uint32_t field = 0; // index in XsScriptInfo.fields
  bool write = false; // a place that the function writes to
  uint32_t room = 0;  // x[room]; 0: not said
  Number number = Number::none;
  double value = 0; // of a number
};

struct Call {
  enum class When : uint8_t { events, event, initialize, poll, shutdown } when = When::events;
  enum class Sends : uint8_t {
    always,
    ifTrue,
    ifFalse
  } sends = Sends::always; // as the function answers
  uint32_t event = 0;      // When::event: the eventIn
  uint32_t line = 1;
  std::string function;
  bool result = false; // the function's value goes to `target`
  Argument target;
  std::vector<Argument> arguments;
};

struct Program {
  std::string library;
  std::vector<Call> calls;
};

using Lookup = std::function<bool(const std::string& function)>;
// The library's name, which stands before the #.
std::string libraryName(std::string_view text);
// Throws ProgramError. exports: whether the library has a function, or one of the libraries it
// uses; own: itself.
Program readProgram(std::string_view text, const XsScriptInfo& info, const Lookup& exports,
                    const Lookup& own);

} // namespace native
