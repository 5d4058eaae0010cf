// newer.h: Tells what of a program is newer than the language that the engine runs. Pure function.
#pragma once

#include <cstdint>
#include <string_view>

namespace ecma {

struct NewerSyntax {
  uint32_t line = 0;  // counted from 1; 0: nothing was found
  char what[10] = ""; // "=>", "let"
};
// Looks in the text of a program that does not compile.
NewerSyntax findNewer(std::string_view program);

} // namespace ecma
