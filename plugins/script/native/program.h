// program.h: Parses the text after native: in a Script's url into a list of calls. A pure function
// of the text, the Script's declarations and the names that the library exports. [the browser's
// thread]
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <xvrml/xscript.h>

namespace native {

// An error, and its line in the program.
struct ProgramError : std::runtime_error {
  ProgramError(uint32_t line, const std::string& what) : std::runtime_error(what), line(line) {}
  uint32_t line;
};

// The C type of a number, if it is not the default for the VRML type.
enum class Number : uint8_t { none, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

struct Argument {
  enum class Kind : uint8_t { field, integer, real, host, self, time } kind = Kind::field;
  enum class Part : uint8_t { whole, data, count } part = Part::whole; // x, x.data, x.count
  uint32_t field = 0; // index in XsScriptInfo.fields
  bool write = false; // the function writes to this argument
  uint32_t room = 0;  // number in x[room]; 0: not given
  Number number = Number::none;
  double value = 0; // value of a literal number
};

struct Call {
  enum class When : uint8_t { events, event, initialize, poll, shutdown } when = When::events;
  // Tells whether the eventOuts are sent always, or depending on the function's result.
  enum class Sends : uint8_t { always, ifTrue, ifFalse } sends = Sends::always;
  uint32_t event = 0; // the eventIn, for When::event
  uint32_t line = 1;
  std::string function;
  bool result = false; // the function's result goes to `target`
  Argument target;
  std::vector<Argument> arguments;
};

struct Program {
  std::string library;
  std::vector<Call> calls;
};

using Lookup = std::function<bool(const std::string& function)>;
// Returns the library's name, which precedes the #.
std::string libraryName(std::string_view text);
// Parses a program. Throws ProgramError. exports: tells whether the library, or a library it uses,
// has a function; own: considers only the library itself.
Program readProgram(std::string_view text, const XsScriptInfo& info, const Lookup& exports,
                    const Lookup& own);

} // namespace native
